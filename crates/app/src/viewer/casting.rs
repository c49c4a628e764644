//! The volume on the device, and the pictures that are cast of it under a budget.

use super::loading::{Arrived, Skipping};
use super::state::{Arrangement, Clip, EyeMethod, Look, State, Transfer, WarpName};
use crate::failure::Failure;
use crate::layering::Layering;
use crate::look::ModeName;
use std::sync::Arc;
use std::time::Duration;
use wheatstone_core::budget::QualityControl;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::image::Image;
use wheatstone_core::scene::Placement;
use wheatstone_core::skip::Structure;
use wheatstone_core::view::{View, world_from_patient};
use wheatstone_core::volume::Grid;
use wheatstone_render::live::{Activity, Front, LiveError, LiveView};
use wheatstone_render::skip::{BoundsReading, GpuSkipMap};
use wheatstone_render::{Gpu, GpuError, GpuVolume, LayersError, Leap, Prepared, Renderer, Sources, Target};

/// Refreshes that a picture in motion takes at most.
const REFRESHES_IN_MOTION: f64 = 4.0;

/// What has not changed for so long rests, seconds.
const REST_AFTER_S: f64 = 0.25;

/// Casts what a state shows.
pub(crate) struct Casting {
    renderer: Renderer,
    scene: Option<Scene>,
}

/// One volume.
struct Scene {
    grid: Grid,
    volume: GpuVolume,
    skipping: Option<Skipping>,
    settings: Settings,
    /// Of the skip map that the settings have got; none without one.
    structure: Option<Structure>,
    aimed: Vec<View>,
    live: LiveView,
    /// Where the volume is occupied by what was prepared last, as long as that is not known.
    bounds: Option<Bounds>,
    is_resting: bool,
    /// That have been complete.
    pictures: u64,
}

/// Bounds of what has been prepared, on their way from the device.
struct Bounds {
    of: Arc<Prepared>,
    reading: BoundsReading,
}

impl Bounds {
    /// Takes them over if they have arrived; what is still to be waited for.
    fn taken_over(self) -> Result<Option<Self>, GpuError> {
        let Some(occupied) = self.reading.poll()? else { return Ok(Some(self)) };
        self.of.know_occupied(occupied);
        Ok(None)
    }
}

/// Something prepared, and the map that its rays leap by.
struct Made {
    prepared: Arc<Prepared>,
    map: Option<GpuSkipMap>,
}

impl Made {
    /// Begins to read back where the volume is occupied.
    fn bounds(&self, gpu: &Gpu) -> Result<Option<Bounds>, GpuError> {
        let of = Arc::clone(&self.prepared);
        self.map.as_ref().map(|map| Ok(Bounds { of, reading: map.read_bounds(gpu)? })).transpose()
    }
}

/// What has to be prepared anew when it changes.
#[derive(Debug, Clone, PartialEq)]
struct Settings {
    look: Look,
    transfer: Transfer,
    clip: Clip,
    /// Opacities at which layers end; none without layers.
    layers: Option<Vec<f32>>,
}

impl Settings {
    fn of(state: &State) -> Self {
        // Background and handles are drawn over what is cast.
        let look = Look { background: [0.0; 3], ..state.look };
        Self {
            look,
            transfer: state.transfer.clone(),
            clip: Clip { has_handles: false, ..state.clip },
            layers: keeps_layers(state).then(|| state.pace.layers.thresholds.clone()),
        }
    }
}

impl Casting {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { renderer: Renderer::new(gpu)?, scene: None })
    }

    /// Shows another volume; the picture of the last one stays until one of this is complete. What cannot be shown changes
    /// nothing.
    pub(crate) fn receive(
        &mut self,
        gpu: &Gpu,
        arrived: Arrived,
        state: &State,
        aimed: Vec<View>,
    ) -> Result<(), Failure> {
        let Arrived { facts, volume, mut skipping, .. } = arrived;
        let settings = Settings::of(state);
        let structure = skipping.as_ref().and_then(|skipping| skipping.at_rest(&state.look));
        let made =
            prepare(gpu, &mut self.renderer, (&facts.grid, &volume), skipping.as_mut(), structure, state)?;
        let (bounds, prepared) = (made.bounds(gpu)?, made.prepared);
        let (live, aimed, pictures) = match self.scene.take() {
            Some(Scene { mut live, aimed, pictures, .. }) => {
                live.replace(prepared);
                (live, aimed, pictures)
            }
            None => {
                let control = QualityControl::new(REFRESHES_IN_MOTION, REST_AFTER_S);
                let control = control.map_err(|error| live_failure(error.into()))?;
                let live = LiveView::new(gpu, prepared, &aimed, Some(control)).map_err(live_failure)?;
                (live, aimed, 0)
            }
        };
        let (grid, is_resting) = (facts.grid, false);
        self.scene = Some(Scene {
            grid,
            volume,
            skipping,
            settings,
            structure,
            aimed,
            live,
            bounds,
            is_resting,
            pictures,
        });
        Ok(())
    }

    /// Aims at what some views see of what a state shows. While settings change they get the skip map that is made quickly,
    /// and when the eye moves next the one that lets rays leap furthest.
    pub(crate) fn follow(&mut self, gpu: &Gpu, state: &State, aimed: Vec<View>) -> Result<(), Failure> {
        let Self { renderer, scene: Some(scene) } = self else { return Ok(()) };
        let settings = Settings::of(state);
        let (has_changed, has_moved) = (settings != scene.settings, aimed != scene.aimed);
        let structure = scene.skipping.as_ref().and_then(|skipping| {
            if has_changed { skipping.while_edited(&state.look) } else { skipping.at_rest(&state.look) }
        });
        if has_changed || (has_moved && structure != scene.structure) {
            // What cannot be prepared is not tried again.
            let before = std::mem::replace(&mut scene.settings, settings);
            scene.structure = structure;
            let Scene { grid, volume, skipping, .. } = &mut *scene;
            let made = prepare(gpu, renderer, (grid, volume), skipping.as_mut(), structure, state)?;
            scene.bounds = made.bounds(gpu)?;
            let prepared = made.prepared;
            let sample_cost = |settings: &Settings| {
                (settings.look.mode_and_shading(), settings.layers.as_ref().map(Vec::len))
            };
            if sample_cost(&scene.settings) == sample_cost(&before) {
                scene.live.supersede(prepared);
            } else {
                scene.live.replace(prepared);
            }
            scene.is_resting = false;
        }
        if has_moved {
            scene.live.aim(&aimed).map_err(live_failure)?;
            scene.aimed = aimed;
            scene.is_resting = false;
        }
        Ok(())
    }

    /// Hands over as much work as a budget holds, without waiting.
    pub(crate) fn refresh(&mut self, gpu: &Gpu, budget: Duration) -> Result<(), Failure> {
        let Some(scene) = &mut self.scene else { return Ok(()) };
        scene.bounds = scene.bounds.take().map_or(Ok(None), Bounds::taken_over)?;
        let refreshed = scene.live.refresh(gpu, &mut self.renderer, budget);
        if refreshed.is_err() {
            // The front may be the one before.
            scene.pictures += 1;
        }
        let refresh = refreshed.map_err(live_failure)?;
        scene.is_resting = refresh.activity == Activity::Resting;
        if matches!(refresh.activity, Activity::Casting { completes_view: true, .. }) {
            scene.pictures += 1;
        }
        Ok(())
    }

    /// Casts a whole picture of what a state shows, whatever it takes.
    pub(crate) fn render(&mut self, gpu: &Gpu, state: &State, view: View) -> Result<Image, Failure> {
        let Self { renderer, scene } = self;
        let Scene { grid, volume, skipping, .. } = shown(scene)?;
        let structure = skipping.as_ref().and_then(|skipping| skipping.at_rest(&state.look));
        Ok(cast(gpu, renderer, (grid, volume), (skipping.as_mut(), structure), state, view)?.read(gpu)?.image)
    }

    /// Casts a view of what a state shows, once by each skip map that it may get, so that kernels are there when they are wanted.
    pub(crate) fn rehearse(&mut self, gpu: &Gpu, state: &State, view: View) -> Result<(), Failure> {
        let Self { renderer, scene } = self;
        let Scene { grid, volume, skipping, .. } = shown(scene)?;
        cast_by_each_map(gpu, renderer, (grid, volume), skipping.as_mut(), state, view)
    }

    /// The same of a volume that is not to be shown.
    pub(crate) fn rehearse_with(
        &mut self,
        gpu: &Gpu,
        arrived: Arrived,
        state: &State,
        view: View,
    ) -> Result<(), Failure> {
        let Arrived { facts, volume, mut skipping, .. } = arrived;
        cast_by_each_map(gpu, &mut self.renderer, (&facts.grid, &volume), skipping.as_mut(), state, view)
    }

    /// The newest whole picture.
    pub(crate) fn front(&self) -> Option<&Front> {
        self.scene.as_ref().and_then(|scene| scene.live.front())
    }

    /// How fine the newest whole picture is, in words.
    pub(crate) fn described_quality(&self) -> String {
        let Some(front) = self.front() else { return "nothing cast yet".to_owned() };
        let [width, height] = front.pictures().next().map_or([0; 2], |(target, _)| target.size());
        let percent = 100.0 * front.quality().resolution();
        format!("{width}×{height} pixels cast, {percent:.0} % of full resolution")
    }

    /// How many pictures have been complete so far: another number is another front.
    pub(crate) fn pictures(&self) -> u64 {
        self.scene.as_ref().map_or(0, |scene| scene.pictures)
    }

    /// Whether there is nothing left to cast.
    pub(crate) fn is_resting(&self) -> bool {
        self.scene.as_ref().is_none_or(|scene| scene.is_resting)
    }

    /// Where the volume is, if there is one.
    pub(crate) fn placement(&self) -> Option<Placement> {
        self.scene.as_ref().map(|scene| placement(&scene.grid, &scene.settings.look))
    }
}

/// What the eyes see in an area of some pixels, left one first.
pub(crate) fn seen(state: &State, size: [u32; 2]) -> Result<Vec<View>, Failure> {
    Ok(state.stereo.views(&middle(state, size)?, state.camera.distance_m))
}

/// What is cast in an area of some pixels: a view for each eye, one in the middle for both, or those of a light-field display.
pub(crate) fn views(state: &State, size: [u32; 2]) -> Result<Vec<View>, Failure> {
    let light_field = &state.light_field;
    let tile_size = match state.stereo.arrangement {
        Arrangement::Quilt => light_field.tile_size_beside(size),
        Arrangement::LightField | Arrangement::Panel => light_field.tile_size_behind(),
        Arrangement::Mono | Arrangement::SideBySide | Arrangement::Anaglyph => {
            return eyes_views(state, size);
        }
    };
    light_field.views(&state.camera, tile_size).map_err(Failure::input)
}

fn eyes_views(state: &State, size: [u32; 2]) -> Result<Vec<View>, Failure> {
    match state.stereo.method {
        EyeMethod::TwoCasts => seen(state, size),
        EyeMethod::OneCast => Ok(vec![middle(state, size)?]),
    }
}

fn middle(state: &State, size: [u32; 2]) -> Result<View, Failure> {
    state.camera.view(state.stereo.eye_size(size)).map_err(Failure::input)
}

fn placement(grid: &Grid, look: &Look) -> Placement {
    Placement::of_grid(grid, world_from_patient(grid, look.up.direction()))
}

/// Whether volumetric warps are wanted of what has layers.
fn keeps_layers(state: &State) -> bool {
    state.pace.warp == WarpName::Volumetric
        && state.look.mode == ModeName::Dvr
        && !state.stereo.arrangement.is_of_display()
}

fn shown(scene: &mut Option<Scene>) -> Result<&mut Scene, Failure> {
    scene.as_mut().ok_or_else(|| Failure::input("no volume is shown"))
}

fn cast_by_each_map(
    gpu: &Gpu,
    renderer: &mut Renderer,
    volume: (&Grid, &GpuVolume),
    mut skipping: Option<&mut Skipping>,
    state: &State,
    view: View,
) -> Result<(), Failure> {
    let structures = skipping
        .as_ref()
        .map_or([None; 2], |skipping| [skipping.while_edited(&state.look), skipping.at_rest(&state.look)]);
    structures.into_iter().try_for_each(|structure| {
        cast(gpu, renderer, volume, (skipping.as_deref_mut(), structure), state, view).map(drop)
    })
}

fn cast(
    gpu: &Gpu,
    renderer: &mut Renderer,
    volume: (&Grid, &GpuVolume),
    (skipping, structure): (Option<&mut Skipping>, Option<Structure>),
    state: &State,
    view: View,
) -> Result<Target, Failure> {
    let Made { prepared, .. } = prepare(gpu, renderer, volume, skipping, structure, state)?;
    let mut targets = [Target::new(gpu, view.size)?];
    renderer.render(gpu, &prepared, &[view], &mut targets)?;
    let [target] = targets;
    Ok(target)
}

fn prepare(
    gpu: &Gpu,
    renderer: &mut Renderer,
    (grid, volume): (&Grid, &GpuVolume),
    skipping: Option<&mut Skipping>,
    structure: Option<Structure>,
    state: &State,
) -> Result<Made, Failure> {
    let settings = state.settings().map_err(Failure::input)?;
    let parameters = CastParameters::new(&settings, &placement(grid, &state.look));
    // A map of its own for each settings: a picture under way still leaps by the one before.
    let mut map = None;
    let leap = match (skipping, structure) {
        (None, _) => Leap::Nothing,
        (Some(skipping), None) => Leap::IdleBlocks(skipping.builder.values()),
        (Some(skipping), Some(structure)) => {
            Leap::EmptyBlocks(map.insert(skipping.builder.map(gpu, &parameters, structure)?))
        }
    };
    let sources = Sources { leap, ..Sources::volume(volume) };
    let prepared = renderer.prepare(gpu, &sources, parameters)?;
    if !keeps_layers(state) {
        return Ok(Made { prepared: Arc::new(prepared), map });
    }
    let Layering { thresholds, .. } = state.pace.layers.layering().map_err(Failure::input)?;
    match renderer.with_layers(gpu, &prepared, &thresholds) {
        Ok(layered) => Ok(Made { prepared: Arc::new(layered), map }),
        Err(LayersError::Gpu(error)) => Err(Failure::Gpu(error)),
        Err(other) => Err(Failure::Internal(other.into())),
    }
}

/// A device that fails is the device's failure.
fn live_failure(error: LiveError) -> Failure {
    match error {
        LiveError::Gpu(error) => Failure::Gpu(error),
        other => Failure::Internal(other.into()),
    }
}
