// One byte per block, four blocks along x in a word: the layout of core::skip::FieldLayout.

// Index of the word that begins with block 4 * at.x of row at.y in layer at.z, in the first octant.
fn field_word(at: vec3u, blocks: vec3u, row_words: u32) -> u32 {
    return at.x + row_words * (at.y + blocks.y * at.z);
}
