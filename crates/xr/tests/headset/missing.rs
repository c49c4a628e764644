//! What is told when something is missing.

use crate::inside::{Surroundings, inside_with};
use crate::monado::Compositor;
use wheatstone_xr::{Runtime, XrError};

fn without_runtime() -> String {
    let error = Runtime::connect("Wheatstone's tests").map(drop).unwrap_err();
    assert!(matches!(error, XrError::NoRuntime { .. }), "{error:?}");
    error.to_string()
}

#[test]
fn a_runtime_that_does_not_run_is_told() {
    let nothing_runs = Surroundings { compositor: Compositor::None, ..Default::default() };
    inside_with(a_runtime_that_does_not_run_is_told, nothing_runs, |_| {
        assert!(without_runtime().contains("start the headset's software"));
    });
}

#[test]
fn a_runtime_that_is_not_set_up_is_told() {
    let environment = vec![("XR_RUNTIME_JSON", "/nowhere/runtime.json".into())];
    let nothing_set_up = Surroundings { compositor: Compositor::None, environment };
    inside_with(a_runtime_that_is_not_set_up_is_told, nothing_set_up, |_| {
        assert!(without_runtime().contains("XR_RUNTIME_JSON"));
    });
}
