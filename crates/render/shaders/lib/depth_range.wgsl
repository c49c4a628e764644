// Depths from and to, metres; from beyond to where there is nothing.

const NOTHING = vec2f(1e30, -1e30);

fn joined(a: vec2f, b: vec2f) -> vec2f {
    return vec2f(min(a.x, b.x), max(a.y, b.y));
}
