import package::lib::cast_parameters::{parameters};
import package::lib::classified::{Classified};
import package::lib::ray::{Ray};
import package::lib::shading_ray::{SHADING_STEP, log2_transmittance_of_four};

const SHADING_IS_DEAR = true;

const SHADING_TAKES_GRADIENT = false;

// Coloured light from each direction, traced for 4 steps (SP Fig. 9), so weighted that no occlusion is white.
fn shade(ray: Ray, position: vec3f, value: f32, classified: Classified) -> vec4f {
    var lit = vec3f(0.0);
    var unoccluded = vec3f(0.0);
    // Software Vulkan compiles a kernel anew for each dispatch where a uniform alone ends a loop; a place that no sample has
    // joins in.
    let count = parameters.direction_count + u32(position.x > 2.0);
    for (var i = 0u; i < count; i++) {
        let direction = parameters.directions[i].xyz;
        let step = parameters.texture_from_metric * (direction * SHADING_STEP);
        let log2_transmittance = log2_transmittance_of_four(position, step);
        lit += abs(direction) * exp2(log2_transmittance * SHADING_STEP);
        unoccluded += abs(direction);
    }
    let share = select(lit / max(unoccluded, vec3f(1e-6)), vec3f(1.0), count == 0u);
    return vec4f(classified.entry.rgb * share, classified.entry.w);
}
