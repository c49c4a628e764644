import package::lib::cast_parameters::{parameters};
import package::lib::classified::{Classified};
import package::lib::ray::{Ray};
import package::lib::shading_ray::{log2_transmittance_inside};

const SHADING_IS_DEAR = true;

const SHADING_TAKES_GRADIENT = false;

// Radius of the sphere that is sampled, voxel lengths.
const AMBIENT_RADIUS: f32 = 4.0;

const CORNER: f32 = 0.57735027;

const SPHERE_POINTS = array<vec3f, 14>(
    vec3f(1.0, 0.0, 0.0), vec3f(-1.0, 0.0, 0.0),
    vec3f(0.0, 1.0, 0.0), vec3f(0.0, -1.0, 0.0),
    vec3f(0.0, 0.0, 1.0), vec3f(0.0, 0.0, -1.0),
    vec3f(-CORNER, -CORNER, -CORNER), vec3f(CORNER, -CORNER, -CORNER),
    vec3f(-CORNER, CORNER, -CORNER), vec3f(CORNER, CORNER, -CORNER),
    vec3f(-CORNER, -CORNER, CORNER), vec3f(CORNER, -CORNER, CORNER),
    vec3f(-CORNER, CORNER, CORNER), vec3f(CORNER, CORNER, CORNER),
);

// Mean transmittance to 14 points around the sample (SP section 4.1): the axes and the corners of a cube.
fn shade(ray: Ray, position: vec3f, value: f32, classified: Classified) -> vec4f {
    var points = SPHERE_POINTS;
    var sum = 0.0;
    for (var i = 0u; i < 14u; i++) {
        let offset = parameters.texture_from_metric * (points[i] * AMBIENT_RADIUS);
        sum += exp2(log2_transmittance_inside(position + offset) * AMBIENT_RADIUS);
    }
    return vec4f(classified.entry.rgb * (sum / 14.0), classified.entry.w);
}
