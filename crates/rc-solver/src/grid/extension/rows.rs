//! Rows of squares and of their parts: means, interpolation, and the transpose of each.
//!
//! A square has two parts along each axis. Where the number of parts is odd, the last square has one part. The missing
//! part counts as empty.

/// Means over squares from the two rows of their parts. The second row may be missing.
pub(super) fn means(rows: [Option<&[f32]>; 2], means: &mut [f32]) {
    means.fill(0.0);
    for row in rows.into_iter().flatten() {
        let (pairs, rest) = row.as_chunks::<2>();
        for (mean, [a, b]) in means.iter_mut().zip(pairs) {
            *mean += 0.25 * (a + b);
        }
        if let (Some(mean), [last]) = (means.last_mut(), rest) {
            *mean += 0.25 * last;
        }
    }
}

/// Interpolates between the centres of squares along both axes.
///
/// The parts are those of row `iy`. `values` are those of the squares, `width` to a row. `line` is scratch.
pub(super) fn interpolate(values: &[f32], width: usize, iy: usize, line: &mut Vec<f32>, parts: &mut [f32]) {
    let height = values.len() / width;
    let (near, far) = (iy / 2, if iy.is_multiple_of(2) { iy / 2 + height - 1 } else { iy / 2 + 1 } % height);
    let (near, far) = (&values[near * width..][..width], &values[far * width..][..width]);
    // The last square comes before the first, and the first after the last.
    line.clear();
    line.push(0.0);
    line.extend(near.iter().zip(far).map(|(near, far)| 0.75 * near + 0.25 * far));
    line[0] = line[width];
    line.push(line[1]);
    let (pairs, rest) = parts.as_chunks_mut::<2>();
    for (x, [a, b]) in pairs.iter_mut().enumerate() {
        let [before, here, after] = [line[x], line[x + 1], line[x + 2]];
        *a = 0.75 * here + 0.25 * before;
        *b = 0.75 * here + 0.25 * after;
    }
    if let [last] = rest {
        *last = 0.75 * line[width] + 0.25 * line[width - 1];
    }
}

/// Row `iy` of `height` rows of squares, by a quarter of the transpose of [`interpolate`].
///
/// `add_part(weight, y, line)` adds a multiple of row `y` of the `n` rows of parts to a line of `width` values.
pub(super) fn gather(
    [width, n]: [usize; 2],
    [iy, height]: [usize; 2],
    line: &mut Vec<f32>,
    add_part: impl Fn(f32, usize, &mut [f32]),
    squares: &mut [f32],
) {
    // Two squares' parts before and after. Missing parts are zero.
    let padded = 2 * squares.len() + 2;
    line.clear();
    line.resize(padded, 0.0);
    let [before, after] = [(iy + height - 1) % height, (iy + 1) % height];
    for (y, weight) in [(2 * before + 1, 0.25), (2 * iy, 0.75), (2 * iy + 1, 0.75), (2 * after, 0.25)] {
        if y < n {
            add_part(0.25 * weight, y, &mut line[1..=width]);
        }
    }
    line[0] = line[padded - 2];
    line[padded - 1] = line[1];
    for (square, parts) in squares.iter_mut().zip(line.windows(4).step_by(2)) {
        *square = 0.75 * (parts[1] + parts[2]) + 0.25 * (parts[0] + parts[3]);
    }
}
