//! What is on a display without a screen.

/// Pixels in the format of X's window dumps, which `Xvfb -fbdir` keeps in a file.
pub(crate) struct Screenshot {
    pub(crate) size: [usize; 2],
    /// Red, green and blue of each pixel, row by row.
    pub(crate) pixels: Vec<[u8; 3]>,
}

impl Screenshot {
    /// Reads 32 bits per pixel, blue first.
    pub(crate) fn of(file: &[u8]) -> Self {
        let (words, _) = file.as_chunks::<4>();
        let word = |index: usize| u32::from_be_bytes(words[index]) as usize;
        let [header, width, height, bits, row, colors] = [0, 4, 5, 11, 12, 19].map(word);
        assert_eq!(bits, 32, "bits per pixel");
        let pixels = file[header + 12 * colors..]
            .chunks(row)
            .take(height)
            .flat_map(|row| row.as_chunks::<4>().0[..width].iter().map(|[b, g, r, _]| [*r, *g, *b]))
            .collect();
        Self { size: [width, height], pixels }
    }

    /// The colour at parts of the width and height, from the left and the top.
    pub(crate) fn at(&self, x: f64, y: f64) -> [u8; 3] {
        let [width, height] = self.size;
        self.pixels[(y * height as f64) as usize * width + (x * width as f64) as usize]
    }
}
