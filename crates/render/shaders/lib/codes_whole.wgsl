// Stored whole numbers are their own codes.
fn codes_of(lo: f32, hi: f32) -> vec2u {
    return vec2u(round(vec2f(lo, hi)));
}
