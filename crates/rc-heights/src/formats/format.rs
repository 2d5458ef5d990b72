//! Names of the formats of height maps.

/// A format of height maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// NumPy array with two dimensions, or records of points.
    Npy,
    /// Numbers as text, with one row of the map in each line.
    Csv,
    /// Lines of `x y z`.
    Xyz,
    /// ESRI ASCII grid.
    EsriGrid,
    /// Zygo XYZ data file or ASCII data file.
    Zygo,
    /// Surfer grid: 6 text (DSAA), 6 binary (DSBB) and 7 (DSRB).
    Surfer,
    /// Gwyddion simple field 1.0.
    Gsf,
    /// Gwyddion native file, version 2.
    Gwy,
    /// HDF5 with arrays of two or three dimensions.
    Hdf5,
    /// Igor Pro binary wave, version 5.
    Ibw,
    /// MATLAB 5 with arrays of two or more dimensions.
    Mat,
    /// NetCDF, classic and 64-bit.
    NetCdf,
    /// ISO 25178-71, as text and binary.
    Sdf,
    /// ISO 5436-2, now ISO 25178-72.
    X3p,
    /// PNG, 16-bit grayscale.
    Png,
    /// TIFF and BigTIFF, grayscale of 16 bits or more, as integers or floats.
    Tiff,
    /// Digital Surf, plain or compressed.
    Sur,
    /// Bruker Nanoscope.
    Nanoscope,
    /// Wyko (Bruker Vision).
    Opd,
    /// Zygo MetroPro.
    MetroPro,
    /// Alicona.
    Al3d,
    /// Sensofar, binary.
    Plu,
    /// Sensofar, an archive.
    Plux,
    /// Keyence VK.
    Vk4,
    /// Nanosurf.
    Nid,
    /// WSxM, images.
    Wsxm,
    /// Bruker Dektak and Vision.
    Opdx,
    /// FRT MicroProf.
    Frt,
    /// Image Metrology BCR.
    Bcr,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 29] = [
        Self::Npy,
        Self::Csv,
        Self::Xyz,
        Self::EsriGrid,
        Self::Zygo,
        Self::Surfer,
        Self::Gsf,
        Self::Gwy,
        Self::Hdf5,
        Self::Ibw,
        Self::Mat,
        Self::NetCdf,
        Self::Sdf,
        Self::X3p,
        Self::Png,
        Self::Tiff,
        Self::Sur,
        Self::Nanoscope,
        Self::Opd,
        Self::MetroPro,
        Self::Al3d,
        Self::Plu,
        Self::Plux,
        Self::Vk4,
        Self::Nid,
        Self::Wsxm,
        Self::Opdx,
        Self::Frt,
        Self::Bcr,
    ];
}

impl std::fmt::Display for Format {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Npy => "npy",
            Self::Csv => "csv",
            Self::Xyz => "xyz",
            Self::EsriGrid => "ESRI ASCII grid",
            Self::Zygo => "Zygo text",
            Self::Surfer => "Surfer grid",
            Self::Gsf => "Gwyddion simple field",
            Self::Gwy => "Gwyddion",
            Self::Hdf5 => "HDF5",
            Self::Ibw => "Igor wave",
            Self::Mat => "MATLAB 5",
            Self::NetCdf => "NetCDF",
            Self::Sdf => "sdf",
            Self::X3p => "x3p",
            Self::Png => "PNG",
            Self::Tiff => "TIFF",
            Self::Sur => "Digital Surf",
            Self::Nanoscope => "Nanoscope",
            Self::Opd => "Wyko OPD",
            Self::MetroPro => "MetroPro",
            Self::Al3d => "al3d",
            Self::Plu => "plu",
            Self::Plux => "plux",
            Self::Vk4 => "Keyence VK",
            Self::Nid => "Nanosurf",
            Self::Wsxm => "WSxM",
            Self::Opdx => "OPDx",
            Self::Frt => "MicroProf",
            Self::Bcr => "BCR-STM",
        })
    }
}
