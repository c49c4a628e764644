import package::lib::range_uniform::{uniforms};

fn stored_of(code: u32) -> f32 {
    return min(f32(code) * uniforms.stored_per_code + uniforms.stored_at_zero, uniforms.largest_stored);
}

// A code near a stored number.
fn code_near(stored: f32) -> u32 {
    let position = (stored - uniforms.stored_at_zero) / uniforms.stored_per_code;
    return u32(clamp(position, 0.0, f32(uniforms.last_code)));
}

// The last code of a number that is not above x; the first if there is none.
fn code_at_most(x: f32) -> u32 {
    var code = min(code_near(x) + 1u, uniforms.last_code);
    while code > 0u && stored_of(code) > x {
        code--;
    }
    return code;
}

// The first code of a number that is not below x; the last if there is none.
fn code_at_least(x: f32) -> u32 {
    var code = max(code_near(x), 1u) - 1u;
    while code < uniforms.last_code && stored_of(code) < x {
        code++;
    }
    return code;
}

// Floats are rounded outward.
fn codes_of(lo: f32, hi: f32) -> vec2u {
    // All voxels are equal: every code is that number. Were the uniform alone to decide, Mesa 22 would compile the kernel anew for each part.
    if lo >= hi && uniforms.stored_per_code <= 0.0 {
        return vec2u(0u);
    }
    let widened = select(0.0, uniforms.rounding, lo < hi);
    return vec2u(code_at_most(lo - widened), code_at_least(hi + widened));
}
