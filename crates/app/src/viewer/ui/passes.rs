//! Input of a refresh, pass by pass.

use egui::{Context, Event, FullOutput, RawInput, Ui};

/// Lays out as many passes as the input of a refresh takes: each press and each release of a button gets one of its own, for within
/// one pass a pointer that is pressed, moved and released has only been clicked; and another begins where other keys are held.
pub(crate) fn run_passes(context: &Context, input: RawInput, mut lay_out: impl FnMut(&mut Ui)) -> FullOutput {
    let mut output = FullOutput::default();
    for input in passes(input) {
        output.append(context.run_ui(input, &mut lay_out));
    }
    output
}

fn passes(mut input: RawInput) -> Vec<RawInput> {
    let events = std::mem::take(&mut input.events);
    let is_button = |event: &Event| matches!(event, Event::PointerButton { .. });
    let mut passes: Vec<RawInput> = events
        .chunk_by(|one, next| {
            !is_button(one) && !is_button(next) && !matches!(next, Event::ModifiersChanged(_))
        })
        .map(|events| RawInput { events: events.to_vec(), dropped_files: Vec::new(), ..input.clone() })
        .collect();
    match passes.first_mut() {
        Some(first) => first.dropped_files = std::mem::take(&mut input.dropped_files),
        None => passes.push(input),
    }
    passes
}
