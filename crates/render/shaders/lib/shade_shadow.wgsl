import package::lib::cast_parameters::{parameters};
import package::lib::classified::{Classified};
import package::lib::ray::{Ray};
import package::lib::shading_ray::{SHADING_STEP, log2_transmittance_along};

const SHADING_IS_DEAR = true;

const SHADING_TAKES_GRADIENT = false;

const SHADOW_SAMPLES: u32 = 24u;

// Transmittance towards the light (SP section 4.1: 24 samples).
fn shade(ray: Ray, position: vec3f, value: f32, classified: Classified) -> vec4f {
    let log2_transmittance = log2_transmittance_along(position, parameters.shadow_step, SHADOW_SAMPLES);
    let light = exp2(log2_transmittance * SHADING_STEP);
    return vec4f(classified.entry.rgb * light, classified.entry.w);
}
