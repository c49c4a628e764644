import package::lib::lut_1d::{lut_at};
import package::lib::ray::{Ray};
import package::lib::ray_state::{Pixel, RayState, opaque_pixel};
import package::lib::value_sum::{accumulate, start_ray};

// Mean of the values.
fn finish_ray(ray: Ray, state: RayState) -> Pixel {
    return opaque_pixel(lut_at(state.scalar / f32(ray.sample_count)).rgb, state);
}
