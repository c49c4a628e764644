// What the nearest anchor does not see of a view: between the two passes that derive it.

// What passes a ray where it ends: `LEAST_THROUGH` of the host.
const LEAST_THROUGH: f32 = 0.01;

// The part of a pixel that the nearest anchor may not know before all are asked: `LEAST_UNKNOWN` of the host.
const LEAST_UNKNOWN: f32 = 0.0625;

// Rays of four rows of a column, where the anchor does not see on.
struct Unknown {
    // What gets there; 0 if the ray ends before.
    through: vec4f,
    // The slab; this and what follows only if more than `LEAST_UNKNOWN` of one of the four gets there.
    first_slab: vec4u,
    // What is before it, premultiplied.
    r: vec4f,
    g: vec4f,
    b: vec4f,
}
