//! The Morton curve through the squares of a grid.

/// Position of a square along the Morton curve through all squares of its size.
///
/// The square is at column `ix` and row `iy`. The position has the bits of `iy` and `ix` in turn. Squares that are near
/// each other are mostly near along the curve. Source: G. M. Morton, *A computer oriented geodetic data base*, IBM
/// Ottawa, 1966.
pub(crate) const fn morton_code(ix: u32, iy: u32) -> u64 {
    spread(ix) | (spread(iy) << 1)
}

/// Column and row of the square at this position.
pub(crate) fn place_of(code: u64) -> [u32; 2] {
    [gather(code), gather(code >> 1)]
}

/// Moves bit i of `v` to bit 2i.
const fn spread(v: u32) -> u64 {
    let mut v = v as u64;
    v = (v | (v << 16)) & 0x0000_FFFF_0000_FFFF;
    v = (v | (v << 8)) & 0x00FF_00FF_00FF_00FF;
    v = (v | (v << 4)) & 0x0F0F_0F0F_0F0F_0F0F;
    v = (v | (v << 2)) & 0x3333_3333_3333_3333;
    (v | (v << 1)) & 0x5555_5555_5555_5555
}

/// Moves bit 2i of `v` to bit i and drops odd bits.
///
/// It is the inverse of the spreading in [`morton_code`].
pub(crate) fn gather(v: u64) -> u32 {
    let mut v = v & 0x5555_5555_5555_5555;
    v = (v | (v >> 1)) & 0x3333_3333_3333_3333;
    v = (v | (v >> 2)) & 0x0F0F_0F0F_0F0F_0F0F;
    v = (v | (v >> 4)) & 0x00FF_00FF_00FF_00FF;
    v = (v | (v >> 8)) & 0x0000_FFFF_0000_FFFF;
    (v | (v >> 16)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_morton_code_has_the_bits_of_both_in_turn() {
        assert_eq!(morton_code(0b101, 0b011), 0b01_10_11);
        assert_eq!((morton_code(u32::MAX, 0), morton_code(0, u32::MAX)), (u64::MAX / 3, u64::MAX / 3 * 2));
        for place in [[0, 0], [5, 3], [u32::MAX, 77], [1 << 20, u32::MAX]] {
            assert_eq!(place_of(morton_code(place[0], place[1])), place);
        }
    }
}
