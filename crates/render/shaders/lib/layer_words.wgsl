// A layer of emission and absorption in four words: the depths between which it is, metres, and what it adds to the picture,
// premultiplied half floats. All zero where there is none.

fn layer_words(start_m: f32, end_m: f32, color: vec4f) -> vec4u {
    return vec4u(bitcast<u32>(start_m), bitcast<u32>(end_m), pack2x16float(color.rg), pack2x16float(color.ba));
}

fn layer_color(words: vec4u) -> vec4f {
    return vec4f(unpack2x16float(words.z), unpack2x16float(words.w));
}
