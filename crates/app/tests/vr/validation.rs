//! What Vulkan's validation layer says of a session.

use crate::monado::Compositor;
use crate::support::Place;

#[test]
fn vulkans_validation_layer_has_nothing_to_say() {
    let Some(place) = Place::start(Compositor::Null) else { return };
    let layers = [("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation"), ("VK_LOADER_DEBUG", "layer")];
    let vr = ["vr", "sphere.nrrd", "--no-mirror", "--floor", "--json", "--refreshes", "30"];
    let more = ["--check-every", "10", "--depth-layer"];
    let run = place.begin("validated", &[&vr[..], &more].concat(), &layers).wait();
    let report = run.json();
    assert_eq!(report["refreshes"], 30);
    assert_eq!(report["depth_layer"], true);
    let said = &run.stderr;
    assert!(said.contains("Insert instance layer \"VK_LAYER_KHRONOS_validation\""), "{said}");
    assert!(
        !said.contains("Validation Error") && !said.contains("Validation Warning") && !said.contains("VUID"),
        "{said}"
    );
}
