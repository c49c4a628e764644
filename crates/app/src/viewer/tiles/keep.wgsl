// A picture as it was cast, for passes that interpolate it.

@group(0) @binding(0) var picture: texture_2d<f32>;

@fragment
fn keep(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    return textureLoad(picture, vec2u(pixel.xy), 0);
}
