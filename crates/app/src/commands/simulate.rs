//! `simulate`: what an eye in front of a light-field display sees.

use crate::display::{Display, DisplayArgs, read_calibration};
use crate::failure::Failure;
use crate::output::{check_apart, check_writable, described, numbered, print_json};
use crate::picture::{Bits, read_png, write_png};
use crate::progress::Bar;
use crate::spec;
use clap::Args;
use glam::DVec3;
use serde_json::json;
use std::path::{Path, PathBuf};
use wheatstone_core::image::RgbImage;
use wheatstone_core::lightfield::simulator::Eye;
use wheatstone_core::lightfield::{Lenticular, ProjectorArray, QuiltDisplay};

/// Show what an eye in front of a light-field display sees of a quilt, an interlaced picture or frames for projectors.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    wheatstone simulate head_qs8x6a0.75.png -o seen.png\n  \
    wheatstone simulate head_qs8x6a0.75.png -o left.png --eye=-0.032,0,0.65\n  \
    wheatstone simulate head_qs8x6a0.75.png -o walk.png --eye=-0.2,0,0.65 --walk 0.2,0,0.65 --frames 30\n  \
    wheatstone simulate head_interlaced.png -o seen.png --interlaced visual.json\n  \
    wheatstone simulate frame_*.png -o seen.png --display agus-2008 --eye 0.1,0,1\n\n\
    Eyes are in metres from the middle of the screen: to the right, up and towards the viewers.")]
pub(crate) struct SimulateArgs {
    /// The quilt, the interlaced picture, or all frames for the projectors.
    #[arg(value_name = "PICTURE.png", required = true)]
    pictures: Vec<PathBuf>,

    /// The PNG file to write: the screen from edge to edge.
    #[arg(short, long, value_name = "OUT.png")]
    output: PathBuf,

    /// Where the eye is [default: before the middle of the screen, as far away as the display is made for].
    #[arg(long, value_name = "X,Y,Z", value_parser = spec::eye, allow_hyphen_values = true)]
    eye: Option<DVec3>,

    /// Write pictures, numbered from 0000, on a straight walk to here.
    #[arg(long, value_name = "X,Y,Z", value_parser = spec::eye, allow_hyphen_values = true)]
    walk: Option<DVec3>,

    /// Pictures of a walk, both ends included [default: 24].
    #[arg(long, value_name = "N", requires = "walk", value_parser = clap::value_parser!(u32).range(2..=10_000), allow_negative_numbers = true)]
    frames: Option<u32>,

    /// Width and height of what is seen, pixels [default: those of a view or of a projector's image].
    #[arg(long, value_name = "WxH", value_parser = spec::display_picture_size)]
    size: Option<[u32; 2]>,

    /// The picture is interlaced by this calibration (visual.json).
    #[arg(long, value_name = "CALIBRATION.json")]
    interlaced: Option<PathBuf>,

    /// Bits per channel of the PNG files.
    #[arg(long, value_enum, default_value = "8")]
    bits: Bits,

    /// Print one JSON object on standard output.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    display: DisplayArgs,
}

/// Pictures of a walk if no number is given.
const USUAL_FRAMES: u32 = 24;

/// A display with what it shows.
enum Shown {
    Quilt { display: QuiltDisplay, views: Vec<RgbImage> },
    Interlaced { display: QuiltDisplay, lenses: Lenticular, picture: RgbImage },
    Projectors { array: ProjectorArray, images: Vec<RgbImage> },
}

/// Runs the command.
pub(crate) fn run(args: &SimulateArgs) -> Result<(), Failure> {
    check_writable(&args.output, "png")?;
    let outputs = args.outputs();
    let flags = [args.interlaced.as_deref(), args.display.file()];
    let pictures = args.pictures.iter().map(PathBuf::as_path);
    check_apart(&outputs, pictures.chain(flags.into_iter().flatten()))?;
    let shown = args.shown()?;
    let eyes = args.eyes(&shown)?;
    for eye in &eyes {
        shown.warn_of_borders(eye);
    }
    let bar = Bar::new("eyes", eyes.len() as u64);
    for (path, eye) in outputs.iter().zip(&eyes) {
        write_png(path, &shown.seen_from(eye)?, args.bits)?;
        bar.advance();
    }
    drop(bar);
    args.report(&shown, &eyes, &outputs)
}

impl SimulateArgs {
    /// Places of the eye.
    fn steps(&self) -> u32 {
        if self.walk.is_some() { self.frames.unwrap_or(USUAL_FRAMES) } else { 1 }
    }

    /// A picture for each of them.
    fn outputs(&self) -> Vec<PathBuf> {
        match self.walk {
            Some(_) => (0..self.steps()).map(|step| numbered(&self.output, step)).collect(),
            None => vec![self.output.clone()],
        }
    }

    fn shown(&self) -> Result<Shown, Failure> {
        let lenses = self.interlaced.as_deref().map(read_calibration).transpose()?;
        match (self.display.resolve(lenses.as_ref())?, lenses) {
            (Display::Projectors(array), _) => Shown::of_frames(array, &self.pictures),
            (Display::Lenses(display), lenses) => {
                let [path] = &self.pictures[..] else {
                    return Err(Failure::input(format!(
                        "{} pictures: a display behind lenses shows one",
                        self.pictures.len()
                    )));
                };
                let picture = read_png(path)?;
                match lenses {
                    Some(lenses) => Ok(Shown::Interlaced { display, lenses, picture }),
                    None => self.quilt(display, path, &picture),
                }
            }
        }
    }

    fn quilt(&self, display: QuiltDisplay, path: &Path, quilt: &RgbImage) -> Result<Shown, Failure> {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let display = self.display.of_quilt(display, &name, [quilt.width, quilt.height])?;
        let views = display.views_of(quilt);
        let views = views.map_err(|error| Failure::input(format!("{}: {error}", path.display())))?;
        Ok(Shown::Quilt { display, views })
    }

    fn eyes(&self, shown: &Shown) -> Result<Vec<Eye>, Failure> {
        let from_m = self.eye.unwrap_or(shown.usual_eye_m());
        let size_px = self.size.unwrap_or(shown.usual_size_px());
        let eye = |position_m| Eye::new(position_m, size_px).map_err(Failure::input);
        let Some(to_m) = self.walk else { return Ok(vec![eye(from_m)?]) };
        let last = self.steps() - 1;
        (0..=last).map(|step| eye(from_m.lerp(to_m, f64::from(step) / f64::from(last)))).collect()
    }

    fn report(&self, shown: &Shown, eyes: &[Eye], outputs: &[PathBuf]) -> Result<(), Failure> {
        if self.json {
            let outputs: Vec<String> = outputs.iter().map(|path| path.display().to_string()).collect();
            let eyes_m: Vec<[f64; 3]> = eyes.iter().map(|eye| eye.position_m().to_array()).collect();
            return print_json(&json!({
                "shown": shown.kind(),
                "screen_size_m": shown.screen_size_m(),
                "eyes_m": eyes_m,
                "size": eyes.first().map(Eye::size_px),
                "outputs": outputs,
            }));
        }
        eprintln!("{} as seen from {} → {}", shown.kind(), places(eyes), described(outputs));
        Ok(())
    }
}

impl Shown {
    fn of_frames(array: ProjectorArray, paths: &[PathBuf]) -> Result<Self, Failure> {
        let mut images: Vec<Option<RgbImage>> = vec![None; array.projectors().len()];
        for path in paths {
            let bad = |error: &dyn std::fmt::Display| Failure::input(format!("{}: {error}", path.display()));
            for (projector, image) in array.unpack(&read_png(path)?).map_err(|error| bad(&error))? {
                if images[projector].replace(image).is_some() {
                    let id = array.projectors()[projector].id;
                    return Err(bad(&format_args!("it has the image of projector {id}, which came before")));
                }
            }
        }
        let missing = images.iter().position(Option::is_none).map(|index| array.projectors()[index].id);
        if let Some(id) = missing {
            return Err(Failure::input(format!("no frame has the image of projector {id}")));
        }
        Ok(Self::Projectors { array, images: images.into_iter().flatten().collect() })
    }

    fn kind(&self) -> &'static str {
        match self {
            Self::Quilt { .. } => "quilt",
            Self::Interlaced { .. } => "interlaced",
            Self::Projectors { .. } => "projectors",
        }
    }

    fn screen_size_m(&self) -> [f64; 2] {
        match self {
            Self::Quilt { display, .. } | Self::Interlaced { display, .. } => display.screen_size_m(),
            Self::Projectors { array, .. } => array.description().screen_size_m,
        }
    }

    fn usual_eye_m(&self) -> DVec3 {
        match self {
            Self::Quilt { display, .. } | Self::Interlaced { display, .. } => {
                DVec3::Z * display.focal_distance_m
            }
            Self::Projectors { array, .. } => array.virtual_viewer_m(),
        }
    }

    fn usual_size_px(&self) -> [u32; 2] {
        match self {
            Self::Quilt { display, .. } | Self::Interlaced { display, .. } => display.tile_size_px(),
            Self::Projectors { array, .. } => array.description().image_size_px,
        }
    }

    /// Tells of an eye that sees the middle of the screen from beyond the view cone.
    fn warn_of_borders(&self, eye: &Eye) {
        let (Self::Quilt { display, .. } | Self::Interlaced { display, .. }) = self else { return };
        let position_m = eye.position_m();
        let share = display.share_of_camera(position_m.x / position_m.z * display.focal_distance_m);
        if !(0.0..=1.0).contains(&share) {
            eprintln!(
                "warning: an eye at {position_m} is beyond the view cone of {} degrees: views begin anew there",
                display.view_cone_deg
            );
        }
    }

    fn seen_from(&self, eye: &Eye) -> Result<RgbImage, Failure> {
        match self {
            Self::Quilt { display, views } => display.seen_from(eye, views).map_err(Failure::input),
            Self::Interlaced { display, lenses, picture } => {
                lenses.seen_from(eye, display, picture).map_err(Failure::input)
            }
            Self::Projectors { array, images } => array.seen_from(eye, images).map_err(Failure::input),
        }
    }
}

/// Eyes in words.
fn places(eyes: &[Eye]) -> String {
    match eyes {
        [] => "nowhere".to_owned(),
        [one] => one.position_m().to_string(),
        [first, .., last] => format!("{} … {}", first.position_m(), last.position_m()),
    }
}
