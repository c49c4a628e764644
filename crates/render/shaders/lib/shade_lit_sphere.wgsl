import package::lib::cast_parameters::{parameters};
import package::lib::classified::{Classified};
import package::lib::flat::{FLAT_SQUARED};
import package::lib::ray::{LEAST_SQUARED, Ray, viewpoint_direction};
import package::lib::view::{view};
import package::lib::volume::{trilinear};

const SHADING_IS_DEAR = true;

const SHADING_TAKES_GRADIENT = true;

// Texels along a side of a lit sphere.
const LIT_SPHERE_SIDE: f32 = 64.0;

// How samples look by the normal in eye space, +x to the right and +y up, -1 to 1: what the colour is multiplied by and the white
// that is added, of value 0 in the first slice and of value 1 in the second; what the density is multiplied by, in the third and
// the fourth.
@group(1) @binding(6) var lit_spheres: texture_3d<f32>;

// The normal in eye space, to the right and upwards, of the side that faces the eye; zero where the value does not change.
fn facing(ray: Ray, position: vec3f, gradient: vec3f) -> vec2f {
    let squared = dot(gradient, gradient);
    if squared < FLAT_SQUARED {
        return vec2f(0.0);
    }
    let normal = gradient * inverseSqrt(squared);
    let to_eye = viewpoint_direction(ray, position);
    let up_in_picture = parameters.metric_from_texture * -(view.origin_dy + view.direction_dy);
    let upwards = up_in_picture - to_eye * dot(to_eye, up_in_picture);
    let up = upwards * inverseSqrt(max(dot(upwards, upwards), LEAST_SQUARED));
    let seen = vec2f(dot(normal, cross(up, to_eye)), dot(normal, up));
    return select(seen, -seen, dot(normal, to_eye) < 0.0);
}

// The look of a sample: between those of the styles for low and for high values.
fn shade(ray: Ray, position: vec3f, value: f32, classified: Classified) -> vec4f {
    let at = (facing(ray, position, classified.gradient) * 0.5 + 0.5) * (LIT_SPHERE_SIDE - 1.0) + 0.5;
    let on_sphere = at / LIT_SPHERE_SIDE;
    let slice = (value + 0.5) / 4.0;
    let look = textureSampleLevel(lit_spheres, trilinear, vec3f(on_sphere, slice), 0.0);
    let density = textureSampleLevel(lit_spheres, trilinear, vec3f(on_sphere, slice + 0.5), 0.0).x;
    let rgb = min(classified.entry.rgb * look.rgb + look.w, vec3f(1.0));
    return vec4f(rgb, classified.entry.w * density);
}
