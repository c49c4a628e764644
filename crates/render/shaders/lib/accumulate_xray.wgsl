import package::lib::cast_parameters::{parameters};
import package::lib::lut_1d::{lut_at};
import package::lib::ray::{Ray};
import package::lib::ray_state::{Pixel, RayState, opaque_pixel};
import package::lib::value_sum::{accumulate, start_ray};

// Loop iterations of a sample at most.
const ITERATIONS_PER_SAMPLE: u32 = 2u;

// Integral of the values over the volume's longest side.
fn finish_ray(ray: Ray, state: RayState) -> Pixel {
    let integral = state.scalar * ray.step_length * parameters.xray_scale;
    return opaque_pixel(lut_at(min(integral, 1.0)).rgb, state);
}
