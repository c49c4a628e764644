//! Some views of a volume by both methods.

use super::row::{Method, Row};
use crate::backend::{Engine, Shot, Underived, median, milliseconds};
use crate::failure::Failure;
use crate::progress::Bar;
use glam::DAffine3;
use wheatstone_core::image::RgbImage;
use wheatstone_core::lightfield::QuiltDisplay;
use wheatstone_core::lightfield::quilt::Sampling;
use wheatstone_core::metrics::compare;
use wheatstone_core::view::View;

/// What is measured.
pub(super) struct Measurement<'a> {
    pub(super) volume: &'a str,
    pub(super) shading: String,
    pub(super) display: QuiltDisplay,
    pub(super) display_from_world: DAffine3,
    /// How many anchors; as many as it takes if not given.
    pub(super) anchors: Option<u32>,
    pub(super) rounds: u32,
}

/// Times of a method, ms.
#[derive(Default)]
struct Times {
    /// Of the anchors of each round.
    anchors: Vec<f64>,
    /// Of all views of each round, with the anchors.
    all: Vec<f64>,
}

impl Measurement<'_> {
    /// A row for each method that makes the views.
    pub(super) fn rows(&self, engine: &mut Engine<'_>, shot: Shot) -> Result<Vec<Row>, Failure> {
        let views = self.display.views(Sampling::Middles, self.display_from_world);
        let title = format!("{}, {} views, {}", self.volume, views.len(), self.shading);
        let bar = Bar::new(title, u64::from(self.rounds) + 1);
        let anchors = match engine.cast_anchors(shot, &views, self.anchors) {
            Ok(anchors) => Some(anchors),
            Err(Underived::Gpu(error)) => return Err(error.into()),
            Err(Underived::Refused(why)) => {
                eprintln!("note: {} views of {} have no anchors: {why}", views.len(), self.volume);
                None
            }
        };
        let mut errors = Vec::new();
        for (index, view) in views.iter().enumerate() {
            engine.cast(shot, &[*view])?;
            let own = pictured(engine)?;
            if anchors.is_some() {
                engine.derive(index)?;
                errors.push(compare(&pictured(engine)?, &own).map_err(Failure::input)?.dssim());
            }
        }
        bar.advance();
        let (mut each, mut of_anchors) = (Times::default(), Times::default());
        for round in 0..self.rounds {
            let mut methods = [Method::Each, Method::Anchors];
            methods.rotate_left(round as usize % 2);
            for method in methods {
                match method {
                    Method::Each => each.all.push(each_ms(engine, shot, &views)?),
                    Method::Anchors if anchors.is_some() => {
                        let [anchors_ms, all_ms] = self.anchors_ms(engine, shot, &views)?;
                        of_anchors.anchors.push(anchors_ms);
                        of_anchors.all.push(all_ms);
                    }
                    Method::Anchors => {}
                }
            }
            bar.advance();
        }
        let each_ms = median(&each.all);
        let row = |method, ms: f64| Row {
            volume: self.volume.to_owned(),
            views: views.len() as u32,
            method,
            shading: self.shading.clone(),
            anchors: 0,
            slabs: 0,
            bytes: 0,
            anchors_ms: 0.0,
            ms,
            rays: views.iter().map(|view| u64::from(view.size[0]) * u64::from(view.size[1])).sum(),
            speed_up: each_ms / ms,
            errors: Vec::new(),
        };
        let mut rows = vec![row(Method::Each, each_ms)];
        if let Some(anchors) = anchors {
            rows.push(Row {
                anchors: anchors.count,
                slabs: anchors.slabs,
                bytes: anchors.bytes,
                anchors_ms: median(&of_anchors.anchors),
                errors,
                ..row(Method::Anchors, median(&of_anchors.all))
            });
        }
        Ok(rows)
    }

    /// Time of anchors, and of all views with them.
    fn anchors_ms(&self, engine: &mut Engine<'_>, shot: Shot, views: &[View]) -> Result<[f64; 2], Failure> {
        let anchors = match engine.cast_anchors(shot, views, self.anchors) {
            Ok(anchors) => milliseconds(anchors.time),
            Err(Underived::Gpu(error)) => return Err(error.into()),
            Err(Underived::Refused(why)) => return Err(Failure::input(why)),
        };
        let mut all = anchors;
        for index in 0..views.len() {
            all += milliseconds(engine.derive(index)?);
        }
        Ok([anchors, all])
    }
}

/// Time of a cast for each view.
fn each_ms(engine: &mut Engine<'_>, shot: Shot, views: &[View]) -> Result<f64, Failure> {
    let mut all = 0.0;
    for view in views {
        all += milliseconds(engine.cast(shot, &[*view])?);
    }
    Ok(all)
}

/// The picture of the last view, before black.
fn pictured(engine: &mut Engine<'_>) -> Result<RgbImage, Failure> {
    let casts = engine.read()?;
    let cast = casts.first().ok_or_else(|| Failure::input("no view was cast"))?;
    Ok(cast.image.over_background([0.0; 3]))
}
