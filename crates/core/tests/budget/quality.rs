use crate::simulation::{AVAILABLE_S, PERIOD_S};
use wheatstone_core::budget::{CastSchedule, CellGrid, Predictor, Quality, QualityControl, ViewRequest};

const FULL_SIZE: [u32; 2] = [1024, 768];
const FULL_REFRESHES: f64 = 18.0;
const TARGET_REFRESHES: f64 = 3.0;
const REST_AFTER_S: f64 = 0.15;

/// Refreshes within which the head moves.
const MOTION: std::ops::Range<usize> = 100..400;

fn request(pose: usize, quality: Quality) -> ViewRequest<(usize, Quality)> {
    let grid = CellGrid::new(quality.size(FULL_SIZE), 32).unwrap();
    ViewRequest::new((pose, quality), grid, quality.work_per_pixel()).unwrap()
}

/// Time of a cell: by its pixels and their samples, and a little by itself.
fn cell_s(request: &ViewRequest<(usize, Quality)>, cell: usize) -> f64 {
    let rect = request.grid().rect(cell);
    let pixels = f64::from((rect.columns.len() * rect.rows.len()) as u32);
    let full_pixels = f64::from(FULL_SIZE[0] * FULL_SIZE[1]);
    FULL_REFRESHES * AVAILABLE_S * pixels / full_pixels * request.work_per_pixel() + 5e-6
}

/// When a view is complete, and which pose and quality it has.
struct Shown {
    refresh: usize,
    pose: usize,
    quality: Quality,
}

/// A head that rests, moves and rests again; the schedule and the control work together as in a viewer.
fn shown() -> Vec<Shown> {
    let mut control = QualityControl::new(TARGET_REFRESHES, REST_AFTER_S).unwrap();
    let mut schedule = CastSchedule::new(request(0, Quality::FULL), Predictor::Corrected);
    let mut quality = Quality::FULL;
    let mut shown = vec![];
    for refresh in 0..700 {
        let now_s = refresh as f64 * PERIOD_S;
        let pose = refresh.clamp(MOTION.start, MOTION.end);
        let begins_to_move = pose == refresh && !control.is_moving(now_s);
        if pose == refresh {
            control.moved(now_s);
        }
        if let (true, Some(view_s)) = (schedule.back().is_none() || begins_to_move, schedule.costs().view_s())
        {
            quality = control.next(now_s, quality, view_s, AVAILABLE_S);
        }
        if begins_to_move {
            schedule.supersede(request(pose, quality));
        } else {
            schedule.aim(request(pose, quality));
        }
        let Some(batch) = schedule.plan(AVAILABLE_S) else { continue };
        let view = if batch.completes_view() { schedule.front() } else { schedule.back() }.unwrap().clone();
        let taken_s: Vec<f64> = batch.cells().iter().map(|&cell| cell_s(&view, cell)).collect();
        schedule.record(&batch, &taken_s).unwrap();
        if batch.completes_view() {
            let (pose, quality) = view.content;
            shown.push(Shown { refresh, pose, quality });
        }
    }
    shown
}

#[test]
fn views_keep_up_with_a_moving_head_and_become_sharp_at_rest() {
    let shown = shown();
    let moving: Vec<&Shown> = shown.iter().filter(|view| MOTION.contains(&view.refresh)).collect();
    let mut levels: Vec<u32> = moving.iter().map(|view| view.quality.level()).collect();
    levels.dedup();
    assert!(levels.len() <= 2 && levels.iter().all(|level| (1..=4).contains(level)), "{levels:?}");
    for pair in moving.windows(2) {
        assert!(pair[1].refresh - pair[0].refresh <= 2 * TARGET_REFRESHES as usize, "{}", pair[1].refresh);
    }
    let last = shown.last().unwrap();
    assert_eq!((last.pose, last.quality), (MOTION.end, Quality::FULL));
    assert!(last.refresh < MOTION.end + 80, "{}", last.refresh);
}
