//! `demo`: the shipped brain, from file to pictures for one eye and two.

use crate::backend::{BackendChoice, Engine, Job, make_on, milliseconds};
use crate::camera::CameraArgs;
use crate::failure::Failure;
use crate::look::{Look, LookArgs};
use crate::output::make_folder;
use crate::picture::Bits;
use crate::progress::Bar;
use crate::shipped::{self, BRAIN_PATH};
use crate::skipping::Skipping;
use crate::spec;
use anyhow::Context as _;
use clap::{Args, Parser};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::image::Image;
use wheatstone_core::volume::{StorageKind, Volume};
use wheatstone_io::write_atomically;

/// A picture of the demo: the flags of `render` that make it.
struct Shot {
    file: &'static str,
    title: &'static str,
    flags: &'static str,
}

const SHOTS: [Shot; 6] = [
    Shot {
        file: "mono.png",
        title: "Composite with Phong shading",
        flags: "--tf mri-brain-t1 --shading phong --azimuth 30 --elevation 12 --distance 1.25 --fov 0.7 --background 101418",
    },
    Shot {
        file: "stereo.png",
        title: "Stereo pair, left eye on the left",
        flags: "--stereo side-by-side --convergence 1.25 --tf mri-brain-t1 --shading phong --azimuth 30 --elevation 12 --distance 1.25 --fov 0.7 --background 101418",
    },
    Shot {
        file: "anaglyph.png",
        title: "Anaglyph for red-cyan glasses",
        flags: "--stereo anaglyph --convergence 1.25 --tf mri-brain-t1 --shading phong --azimuth 30 --elevation 12 --distance 1.25 --fov 0.7 --background 101418",
    },
    Shot {
        file: "mip.png",
        title: "Maximum intensity projection of a slab of 20 mm beside the midline",
        flags: "--mode mip --tf magma --window 120..255 --clip-box 0.4..0.5,0..1,0..1 --azimuth 60 --elevation 10 --distance 1.25 --fov 0.7",
    },
    Shot {
        file: "isosurface.png",
        title: "Isosurface of the white matter",
        flags: "--iso 0.7 --azimuth 30 --elevation 12 --distance 1.25 --fov 0.7 --background 101418",
    },
    Shot {
        file: "cut.png",
        title: "Cut by a plane, with ambient occlusion",
        flags: "--tf mri-brain-t1 --shading ambient --clip-plane=-0.6,0.3,-0.7,0.05 --azimuth 30 --elevation 12 --distance 1.15 --fov 0.7 --background 101418",
    },
];

/// Render the brain that ships with Wheatstone: mono, stereo pair, anaglyph, MIP, isosurface and a cut.
///
/// Writes PNG pictures and index.html, a contact sheet with the command and time of each.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  wheatstone demo\n  wheatstone demo -o pictures --size 1024x1024 --backend gpu"
)]
pub(crate) struct DemoArgs {
    /// Folder for the pictures; made if it is missing.
    #[arg(short, long, value_name = "DIR", default_value = "demo")]
    output: PathBuf,

    /// Width and height of each eye's picture, pixels.
    #[arg(long, value_name = "WxH", default_value = "768x768", value_parser = spec::picture_size)]
    size: [u32; 2],

    /// What casts the rays.
    #[arg(long, value_enum, default_value_t = BackendChoice::Auto)]
    backend: BackendChoice,
}

/// Flags of a [`Shot`].
#[derive(Debug, Parser)]
#[command(no_binary_name = true)]
struct ShotArgs {
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    look: LookArgs,
    #[arg(long, default_value = "000000", value_parser = spec::color)]
    background: [f32; 3],
}

/// A shot with everything that does not depend on the caster.
struct Plan {
    shot: &'static Shot,
    args: ShotArgs,
    look: Look,
    parameters: CastParameters,
}

/// A picture that was written.
struct Taken {
    plan: usize,
    frame_ms: f64,
    samples: u64,
    size: [u32; 2],
}

/// Runs the command.
pub(crate) fn run(args: &DemoArgs) -> Result<(), Failure> {
    let folder = &args.output;
    make_folder(folder)?;
    let loaded = shipped::brain()?;
    let volume = &loaded.volume;
    let plans = SHOTS.iter().map(|shot| plan(shot, args.size, volume)).collect::<Result<Vec<_>, _>>()?;
    let (engine, taken) = make_on(
        args.backend,
        |choice| open(choice, &plans, volume),
        |engine| take_all(engine, &plans, folder),
    )?;
    let sheet = contact_sheet(&plans, &taken, &engine);
    let index = folder.join("index.html");
    write_atomically(&index, |writer| writer.write_all(sheet.as_bytes()))?;
    eprintln!("{} pictures by the {} → {}", taken.len(), caster(&engine), index.display());
    Ok(())
}

fn caster(engine: &Engine<'_>) -> String {
    let kind = if engine.backend_name() == "gpu" { "GPU renderer" } else { "CPU renderer" };
    format!("{kind} ({})", engine.device_name())
}

fn plan(shot: &'static Shot, size: [u32; 2], volume: &Volume) -> Result<Plan, Failure> {
    let mut args = ShotArgs::try_parse_from(shot.flags.split_whitespace())
        .with_context(|| format!("flags of {}", shot.file))?;
    args.camera.size = size;
    let look = args.look.resolve(volume)?;
    let placement = args.camera.aim.placement(volume);
    let parameters = CastParameters::new(&look.settings, &placement);
    Ok(Plan { shot, args, look, parameters })
}

fn open<'v>(choice: BackendChoice, plans: &[Plan], volume: &'v Volume) -> Result<Engine<'v>, Failure> {
    let mut rays = 0;
    for plan in plans {
        let views = plan.args.camera.views(0.0)?;
        rays += views.iter().map(|view| u64::from(view.size[0]) * u64::from(view.size[1])).sum::<u64>();
    }
    let longest = volume.grid().dims().into_iter().max().unwrap_or(1);
    let job = Job { rays, samples_per_ray: longest as f64, needs_gpu: false };
    Engine::open(choice, &job, volume, StorageKind::lossless_for(volume))
}

fn take_all(engine: &mut Engine<'_>, plans: &[Plan], folder: &Path) -> Result<Vec<Taken>, Failure> {
    let bar = Bar::new("pictures", plans.len() as u64);
    let mut taken = Vec::new();
    for (index, plan) in plans.iter().enumerate() {
        let shot = engine.prepare(&plan.parameters, &Skipping::AUTO)?;
        let frame_ms = milliseconds(engine.cast(shot, &plan.args.camera.views(0.0)?)?);
        let casts = engine.read()?;
        let images: Vec<&Image> = casts.iter().map(|cast| &cast.image).collect();
        let picture = plan.args.camera.arrange(&images, plan.args.background);
        picture.write(&folder.join(plan.shot.file), Bits::Eight)?;
        let samples = casts.iter().map(|cast| cast.samples).sum();
        taken.push(Taken { plan: index, frame_ms, samples, size: picture.size() });
        bar.advance();
    }
    Ok(taken)
}

const STYLE: &str = "body{background:#16181d;color:#d8dade;font:16px/1.5 system-ui,sans-serif;margin:2rem auto;\
    max-width:1180px;padding:0 1rem}h1{font-weight:600}main{display:grid;gap:1.5rem;\
    grid-template-columns:repeat(auto-fit,minmax(min(100%,520px),1fr))}figure{margin:0;background:#1e2128;\
    border-radius:8px;overflow:hidden}figure.wide{grid-column:1/-1}img{width:100%;height:auto;display:block}\
    figcaption{padding:.8rem 1rem}h2{font-size:1rem;margin:0}p{margin:.3rem 0}code{font-size:.8rem;\
    color:#9fb4c8;word-break:break-word}";

/// A page of its own that shows the pictures beside it.
fn contact_sheet(plans: &[Plan], taken: &[Taken], engine: &Engine<'_>) -> String {
    let mut figures = String::new();
    for Taken { plan, frame_ms, samples, size } in taken {
        let Plan { shot, args, look, .. } = &plans[*plan];
        let [width, height] = *size;
        let class = if width > height { " class=\"wide\"" } else { "" };
        // Writing to a string cannot fail.
        let _ = writeln!(
            figures,
            "<figure{class}><a href=\"{file}\"><img src=\"{file}\" width=\"{width}\" height=\"{height}\" \
             alt=\"{title}\"></a><figcaption><h2>{title}</h2><p>{width}×{height} · {mode} · shading {shading} · \
             {frame_ms:.0} ms · {msamples:.1} M samples</p><code>wheatstone render {BRAIN_PATH} -o {file} \
             --size {eye_width}x{eye_height} {flags}</code></figcaption></figure>",
            file = shot.file,
            title = shot.title,
            mode = look.mode.name(),
            shading = spec::shading_name(look.settings.shading),
            msamples = *samples as f64 / 1e6,
            eye_width = args.camera.size[0],
            eye_height = args.camera.size[1],
            flags = shot.flags,
        );
    }
    format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Wheatstone demo</title>\
         <meta name=\"viewport\" content=\"width=device-width\"><style>{STYLE}</style></head><body>\n\
         <h1>Wheatstone demo</h1>\n<p>MNI152 T1 template, 197×233×189 voxels of 1 mm, cast by the {}. Times are of \
         the first frame of each picture, without reading it back.</p>\n<main>\n{figures}</main>\n\
         <p>Volume: © 1993–2009 Louis Collins, McConnell Brain Imaging Centre, Montreal Neurological Institute, \
         McGill University.</p>\n</body></html>\n",
        escaped(&caster(engine)),
    )
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shot_has_flags_that_render_takes() {
        for shot in &SHOTS {
            let args = ShotArgs::try_parse_from(shot.flags.split_whitespace()).unwrap();
            args.look.check().unwrap();
            args.camera.check().unwrap();
        }
    }
}
