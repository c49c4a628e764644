import package::lib::cast_parameters::{parameters};
import package::lib::classified::{Classified};
import package::lib::flat::{FLAT_SQUARED};
import package::lib::ray::{Ray, viewpoint_direction};

const SHADING_IS_DEAR = true;

const SHADING_TAKES_GRADIENT = true;

const AMBIENT: f32 = 0.2;
const DIFFUSE: f32 = 0.7;
const SPECULAR: f32 = 0.2;
const SPECULAR_EXPONENT: f32 = 20.0;

// Two-sided Phong. Where the value does not change there is no surface, and the light falls as if head-on.
fn shade(ray: Ray, position: vec3f, value: f32, classified: Classified) -> vec4f {
    let squared = dot(classified.gradient, classified.gradient);
    if squared < FLAT_SQUARED {
        return vec4f(classified.entry.rgb * (AMBIENT + DIFFUSE), classified.entry.w);
    }
    let normal = classified.gradient * inverseSqrt(squared);
    let has_light = any(parameters.to_light != vec3f(0.0));
    let to_viewpoint = viewpoint_direction(ray, position);
    let to_light = select(to_viewpoint, parameters.to_light, has_light);
    let between = to_light + to_viewpoint;
    let half_way = between * inverseSqrt(max(dot(between, between), 1e-12));
    let highlight = SPECULAR * pow(abs(dot(normal, half_way)), SPECULAR_EXPONENT);
    let matte = AMBIENT + DIFFUSE * abs(dot(normal, to_light));
    return vec4f(classified.entry.rgb * matte + highlight, classified.entry.w);
}
