//! The demonstration: what comes out of it is what has been computed.

use crate::hands::*;
use wheatstone_core::head::Display;
use wheatstone_core::headset::{Demonstration, Interaction, Recording, Scale, Stand};
use wheatstone_core::scene::Clip;
use wheatstone_core::view::AnatomicalDirection::{self, Anterior, Left, Superior};
use wheatstone_core::volume::Grid;

/// Plays a recording from where its first tick puts the volume; what is left of the outcome, and how often hands took hold.
fn play(recording: &Recording, grid: &Grid, up: AnatomicalDirection) -> (Interaction, i32, [u32; 2]) {
    let eyes = recording.ticks()[0].between_eyes().unwrap();
    let stand = Stand::before(&eyes, grid, up, Scale::Human);
    let mut interaction = Interaction::new(grid, up, stand, &Clip::default());
    let (mut steps, mut grabbed, mut current) = (0, [0; 2], window());
    for tick in recording.ticks() {
        let changes = interaction.update(tick, current);
        steps += changes.preset_steps;
        current = changes.window;
        grabbed = [0, 1].map(|side: usize| grabbed[side] + u32::from(changes.grabbed[side]));
    }
    assert_eq!(current, window());
    (interaction, steps, grabbed)
}

#[test]
fn it_leads_where_it_says_at_every_rate() {
    let grids = [
        grid(),
        Grid::centred([64, 64, 64], [1.0; 3]).unwrap(),
        Grid::centred([9, 200, 3], [0.5, 2.0, 7.0]).unwrap(),
    ];
    for grid in &grids {
        for (up, rate_hz) in [(Superior, 90.0), (Superior, 12.0), (Anterior, 72.0), (Left, 144.0)] {
            let demonstration = Demonstration::new(grid, up);
            let recording = demonstration.recording(Display::new(rate_hz).unwrap()).unwrap();
            let (interaction, steps, grabbed) = play(&recording, grid, up);
            let outcome = demonstration.outcome();
            assert!(apart(interaction.stand(), &outcome.stand) < 1e-9, "{rate_hz} {:?}", interaction.stand());
            let clip = interaction.clip();
            assert!(
                (clip.box_hi - outcome.clip.box_hi).length() < 1e-9 && clip.box_lo == outcome.clip.box_lo,
                "{clip:?}"
            );
            assert_eq!((steps, grabbed), (outcome.preset_steps, [1, 3]));
            assert!(apart(&outcome.stand, demonstration.stand()) > 0.3 && outcome.clip != Clip::default());
        }
    }
}

#[test]
fn it_leads_there_when_it_is_written_read_and_replayed_at_another_rate() {
    let grid = grid();
    let demonstration = Demonstration::new(&grid, Superior);
    let mut written = Vec::new();
    demonstration.recording(Display::new(60.0).unwrap()).unwrap().write(&mut written).unwrap();
    let read = Recording::read(written.as_slice()).unwrap();
    let replayed = Recording::new(read.replay(Display::new(90.0).unwrap()).collect()).unwrap();
    let (interaction, steps, _) = play(&replayed, &grid, Superior);
    let outcome = demonstration.outcome();
    // Two hands that are interpolated evenly between ticks do not go along the arc that they went, but they get there.
    assert!(apart(interaction.stand(), &outcome.stand) < 1e-9, "{:?}", interaction.stand());
    assert!((interaction.clip().box_hi.x - outcome.clip.box_hi.x).abs() < 1e-9);
    assert_eq!(steps, 1);
}
