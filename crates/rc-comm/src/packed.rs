//! Conversion of values to bytes and back.

/// Numbers that ranks exchange, as little-endian bytes.
pub trait Packed: Copy + Send + Sync + 'static {
    /// Number of bytes of a value.
    const BYTES: usize;

    /// Appends the bytes of `values`.
    fn pack(values: &[Self], bytes: &mut Vec<u8>);

    /// Fills `values` from the first bytes of `bytes`.
    ///
    /// # Panics
    /// When `bytes` is too short.
    fn unpack(bytes: &[u8], values: &mut [Self]);

    /// Converts all bytes to values. An incomplete last value is dropped.
    #[must_use]
    fn unpack_all(bytes: &[u8]) -> Vec<Self>;
}

macro_rules! packed {
    ($($T:ty),*) => {$(
        impl Packed for $T {
            const BYTES: usize = size_of::<$T>();

            fn pack(values: &[Self], bytes: &mut Vec<u8>) {
                bytes.reserve(values.len() * Self::BYTES);
                for value in values {
                    bytes.extend_from_slice(&value.to_le_bytes());
                }
            }

            fn unpack(bytes: &[u8], values: &mut [Self]) {
                let (chunks, _) = bytes.as_chunks::<{ size_of::<$T>() }>();
                let chunks = &chunks[..values.len()];
                for (value, chunk) in values.iter_mut().zip(chunks) {
                    *value = Self::from_le_bytes(*chunk);
                }
            }

            fn unpack_all(bytes: &[u8]) -> Vec<Self> {
                bytes.as_chunks::<{ size_of::<$T>() }>().0.iter().map(|chunk| Self::from_le_bytes(*chunk)).collect()
            }
        }
    )*};
}

packed!(u8, u32, u64, f32, f64);

/// Numbers that belong together, one after the other.
impl<T: Packed, const N: usize> Packed for [T; N] {
    const BYTES: usize = N * T::BYTES;

    fn pack(values: &[Self], bytes: &mut Vec<u8>) {
        T::pack(values.as_flattened(), bytes);
    }

    fn unpack(bytes: &[u8], values: &mut [Self]) {
        T::unpack(bytes, values.as_flattened_mut());
    }

    fn unpack_all(bytes: &[u8]) -> Vec<Self> {
        T::unpack_all(bytes).as_chunks::<N>().0.to_vec()
    }
}
