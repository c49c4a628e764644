//! What a cast produces: premultiplied colour and first-hit depth, on the host.

/// One rendered view in host memory, rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Premultiplied RGBA, display-referred, one per pixel, row by row from the top left.
    pub color: Vec<[f32; 4]>,
    /// Depth of the first visible sample along view −Z, metres; infinite where nothing was hit.
    pub depth_m: Vec<f32>,
}

impl Image {
    /// A transparent image with nothing hit.
    pub fn transparent(width: u32, height: u32) -> Self {
        let pixels = width as usize * height as usize;
        Self { width, height, color: vec![[0.0; 4]; pixels], depth_m: vec![f32::INFINITY; pixels] }
    }

    /// Opaque RGB over a background colour, each channel in [0, 1].
    pub fn over_background(&self, background: [f32; 3]) -> RgbImage {
        let rgb = self
            .color
            .iter()
            .map(|&[r, g, b, a]| {
                let through = 1.0 - a;
                [r + through * background[0], g + through * background[1], b + through * background[2]]
                    .map(|channel| channel.clamp(0.0, 1.0))
            })
            .collect();
        RgbImage { width: self.width, height: self.height, rgb }
    }
}

/// An opaque picture, display-referred, rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct RgbImage {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// RGB in [0, 1], one per pixel, row by row from the top left.
    pub rgb: Vec<[f32; 3]>,
}

impl RgbImage {
    /// A part of the picture: its top left pixel, width and height.
    ///
    /// # Panics
    /// If it reaches beyond the picture.
    pub fn cut(&self, [left, top]: [u32; 2], [width, height]: [u32; 2]) -> Self {
        let row = |y: u32| {
            let first = y as usize * self.width as usize + left as usize;
            self.rgb[first..first + width as usize].iter().copied()
        };
        Self { width, height, rgb: (top..top + height).flat_map(row).collect() }
    }

    /// Puts another picture into this one, its top left pixel to a place.
    ///
    /// # Panics
    /// If it reaches beyond this one.
    pub fn paste(&mut self, part: &Self, [left, top]: [u32; 2]) {
        for (y, row) in part.rgb.chunks(part.width as usize).enumerate() {
            let first = (top as usize + y) * self.width as usize + left as usize;
            self.rgb[first..first + row.len()].copy_from_slice(row);
        }
    }

    /// The means of squares of so many pixels along each side; what is left over on the right and below is left out.
    ///
    /// # Panics
    /// If `side` is 0.
    pub fn averaged(&self, side: u32) -> Self {
        let [width, height] = [self.width, self.height].map(|pixels| pixels / side);
        let share = 1.0 / (side * side) as f32;
        let mean = |x: u32, y: u32| {
            let mut mean = [0.0; 3];
            for row in side * y..side * (y + 1) {
                let first = (row * self.width + side * x) as usize;
                for pixel in &self.rgb[first..first + side as usize] {
                    mean.iter_mut().zip(pixel).for_each(|(mean, channel)| *mean += share * channel);
                }
            }
            mean
        };
        let rgb =
            (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| mean(x, y)).collect();
        Self { width, height, rgb }
    }

    /// The mean of pictures of one size.
    ///
    /// # Panics
    /// Without pictures, or if their sizes differ.
    pub fn mean(pictures: &[Self]) -> Self {
        let mut mean = Self { rgb: vec![[0.0; 3]; pictures[0].rgb.len()], ..pictures[0] };
        let share = 1.0 / pictures.len() as f32;
        for picture in pictures {
            assert_eq!(
                [picture.width, picture.height],
                [mean.width, mean.height],
                "a mean is of pictures of one size"
            );
            for (mean, level) in mean.rgb.iter_mut().flatten().zip(picture.rgb.iter().flatten()) {
                *mean += share * level;
            }
        }
        mean
    }

    /// Two pictures of equal height side by side, the first on the left.
    ///
    /// # Panics
    /// If the heights differ.
    pub fn beside(&self, right: &Self) -> Self {
        assert_eq!(self.height, right.height, "pictures side by side need one height");
        let rows = self.rgb.chunks(self.width as usize).zip(right.rgb.chunks(right.width as usize));
        let rgb = rows.flat_map(|(l, r)| l.iter().chain(r).copied()).collect();
        Self { width: self.width + right.width, height: self.height, rgb }
    }

    /// Two pictures of equal width one above the other, the first on top.
    ///
    /// # Panics
    /// If the widths differ.
    pub fn above(&self, below: &Self) -> Self {
        assert_eq!(self.width, below.width, "pictures above each other need one width");
        let rgb = self.rgb.iter().chain(&below.rgb).copied().collect();
        Self { width: self.width, height: self.height + below.height, rgb }
    }

    /// Red–cyan anaglyph by Dubois' least-squares matrices for the left eye's red and the right eye's cyan
    /// filter (Dubois, "A projection method to generate anaglyph stereo images", ICASSP 2001).
    ///
    /// # Panics
    /// If the sizes differ.
    pub fn anaglyph(&self, right: &Self) -> Self {
        assert_eq!((self.width, self.height), (right.width, right.height), "both eyes need one size");
        const LEFT: [[f32; 3]; 3] =
            [[0.456, 0.500, 0.176], [-0.040, -0.038, -0.016], [-0.015, -0.021, -0.005]];
        const RIGHT: [[f32; 3]; 3] =
            [[-0.043, -0.088, -0.002], [0.378, 0.734, -0.018], [-0.072, -0.113, 1.226]];
        let dot = |row: [f32; 3], c: [f32; 3]| row[0] * c[0] + row[1] * c[1] + row[2] * c[2];
        let rgb = self
            .rgb
            .iter()
            .zip(&right.rgb)
            .map(|(&l, &r)| [0, 1, 2].map(|i| (dot(LEFT[i], l) + dot(RIGHT[i], r)).clamp(0.0, 1.0)))
            .collect();
        Self { width: self.width, height: self.height, rgb }
    }

    /// Channels as 8-bit, rounded.
    pub fn to_rgb8(&self) -> Vec<u8> {
        self.rgb.iter().flatten().map(|c| (c * 255.0 + 0.5) as u8).collect()
    }

    /// Channels as 16-bit, rounded.
    pub fn to_rgb16(&self) -> Vec<u16> {
        self.rgb.iter().flatten().map(|c| (c * 65535.0 + 0.5) as u16).collect()
    }
}
