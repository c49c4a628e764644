// One byte per block, four blocks along x in a word. Rows are padded to 256 bytes, as copies to textures want them.

fn field_row_words(blocks_per_row: u32) -> u32 {
    return (blocks_per_row + 255u) / 256u * 64u;
}

// Index of the word that begins with block 4 * at.x of row at.y in layer at.z.
fn field_word(at: vec3u, blocks: vec3u) -> u32 {
    return at.x + field_row_words(blocks.x) * (at.y + blocks.y * at.z);
}
