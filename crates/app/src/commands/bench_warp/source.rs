//! What warps start from.

use super::warp::WarpName;
use crate::backend::{Engine, GpuWarping, Shot};
use crate::failure::Failure;
use crate::layering::Layering;
use std::time::{Duration, Instant};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::image::Image;
use wheatstone_core::reference::{Aids, Caster};
use wheatstone_core::view::View;
use wheatstone_core::volume::{StorageKind, Volume};
use wheatstone_core::warp::{self, EmissionAbsorption, GridSettings, Reach, WarpError};

/// Casts pictures of one scene, and warps them where they were cast.
pub(super) struct Camera<'e, 'v> {
    pub(super) engine: &'e mut Engine<'v>,
    pub(super) shot: Shot,
    source: Source,
}

/// The picture that is warped.
enum Source {
    Gpu(Box<GpuWarping>),
    Cpu(Box<CpuSource>),
}

/// A picture in host memory.
struct CpuSource {
    view: View,
    image: Image,
    parameters: CastParameters,
    layered: Option<(Caster, Layering)>,
    layers: Option<EmissionAbsorption>,
    warped: Image,
}

/// How long the parts of casting a picture to be warped take.
#[derive(Debug, Clone, Copy)]
pub(super) struct CastTimes {
    /// The picture, and its layers if any warp asks for them.
    pub(super) cast: Duration,
    /// Finding the depths of its layers.
    pub(super) depths: Duration,
}

impl<'e, 'v> Camera<'e, 'v> {
    /// A camera for pictures like a view, with layers for volumetric warps if they are to be made.
    pub(super) fn new(
        engine: &'e mut Engine<'v>,
        shot: Shot,
        (volume, storage, parameters): (&Volume, StorageKind, &CastParameters),
        like: View,
        layering: Option<&Layering>,
    ) -> Result<Self, Failure> {
        let source = match engine {
            Engine::Gpu(engine) => Source::Gpu(Box::new(engine.warping(shot, like, layering)?)),
            Engine::Cpu(_) => {
                let caster = || Caster::with_storage(volume, storage);
                let blank = Image::transparent(like.size[0], like.size[1]);
                Source::Cpu(Box::new(CpuSource {
                    view: like,
                    image: blank.clone(),
                    parameters: parameters.clone(),
                    layered: layering.map(|layering| (caster(), layering.clone())),
                    layers: None,
                    warped: blank,
                }))
            }
        };
        Ok(Self { engine, shot, source })
    }

    /// Casts the picture of a view to be warped.
    pub(super) fn begin(&mut self, view: View) -> Result<CastTimes, Failure> {
        match (&mut *self.engine, &mut self.source) {
            (Engine::Gpu(engine), Source::Gpu(warping)) => {
                let [cast, depths] = engine.cast_warped(warping, view)?;
                Ok(CastTimes { cast, depths })
            }
            (_, Source::Gpu(_)) => Err(mixed()),
            (engine, Source::Cpu(source)) => {
                let start = Instant::now();
                engine.cast(self.shot, &[view])?;
                let layers = source.layered.as_ref().map(|(caster, layering)| {
                    caster.cast_emission_absorption(
                        &source.parameters,
                        &Aids::default(),
                        &view,
                        &layering.thresholds,
                    )
                });
                source.layers = layers.transpose().map_err(Failure::input)?.map(|(_, layers)| layers);
                let cast = start.elapsed();
                source.image = picture(engine)?;
                source.view = view;
                Ok(CastTimes { cast, depths: Duration::ZERO })
            }
        }
    }

    /// Shows the picture as another view wants it; the time is that of the finished warp, without reading back.
    pub(super) fn warp(&mut self, warp: WarpName, wanted: &View) -> Result<Duration, Failure> {
        match (&*self.engine, &mut self.source) {
            (Engine::Gpu(engine), Source::Gpu(warping)) => match warp {
                WarpName::None => Ok(Duration::ZERO),
                WarpName::Quad => engine.quad(warping, wanted),
                WarpName::Grid => engine.grid(warping, wanted),
                WarpName::Volumetric => engine.volumetric(warping, wanted),
            },
            (_, Source::Gpu(_)) => Err(mixed()),
            (_, Source::Cpu(source)) => {
                let start = Instant::now();
                source.warped = source.warp(warp, wanted).map_err(Failure::input)?;
                Ok(start.elapsed())
            }
        }
    }

    /// What the last warp, this one, has made.
    pub(super) fn warped(&self, warp: WarpName) -> Result<Image, Failure> {
        match (&*self.engine, &self.source) {
            (Engine::Gpu(engine), Source::Gpu(warping)) if warp == WarpName::None => {
                engine.read_source(warping)
            }
            (Engine::Gpu(engine), Source::Gpu(warping)) => engine.read_warped(warping),
            (_, Source::Gpu(_)) => Err(mixed()),
            (_, Source::Cpu(source)) => Ok(source.warped.clone()),
        }
    }

    /// Casts a view; also the time, without reading back.
    pub(super) fn cast(&mut self, view: View) -> Result<(Image, Duration), Failure> {
        let time = self.engine.cast(self.shot, &[view])?;
        Ok((picture(self.engine)?, time))
    }
}

impl CpuSource {
    fn warp(&self, warp: WarpName, wanted: &View) -> Result<Image, WarpError> {
        let Self { view, image, parameters, layers, layered, .. } = self;
        match warp {
            WarpName::None => Ok(image.clone()),
            WarpName::Quad => {
                let reach = Reach::of(view, &parameters.occupied_corners_world());
                warp::quad(view, image, wanted, reach.middle())
            }
            WarpName::Grid => warp::grid(view, image, wanted, GridSettings::default()),
            WarpName::Volumetric => match (layers, layered) {
                (Some(layers), Some((_, layering))) => {
                    warp::volumetric(layers, view, wanted, &layering.settings)
                }
                _ => Err(WarpError::NoLayers),
            },
        }
    }
}

fn picture(engine: &mut Engine<'_>) -> Result<Image, Failure> {
    let cast = engine.read()?.pop();
    cast.map(|cast| cast.image).ok_or_else(|| Failure::Internal(anyhow::anyhow!("no picture of a view")))
}

/// A camera is made with the source of its engine.
fn mixed() -> Failure {
    Failure::Internal(anyhow::anyhow!("a picture on another device than its caster"))
}
