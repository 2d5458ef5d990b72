//! Names of the fields before the numbers of a text.

/// What a field before the numbers says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Name {
    /// Size along x (0) or y (1).
    Side(usize),
    /// Sizes along x and y, or one size for both.
    Sides,
    /// Distance of points along x (0) or y (1).
    Spacing(usize),
    /// Distance of points along both axes.
    Spacings,
    /// Number of points along x (0) or y (1).
    Count(usize),
    /// Unit of the heights.
    HeightUnit,
    /// Range of the heights, with their unit.
    HeightRange,
    /// Unit of all lengths that have no other.
    Unit,
    /// Name of the channel.
    Channel,
    /// Name of the channel, in quotes.
    ImageData,
    /// Metres per number.
    Metres,
    /// Number that marks a missing point.
    Missing,
}

/// The names of every field, in small letters and without anything between the words.
const NAMES: &[(Name, &[&str])] = &[
    (
        Name::Side(0),
        &[
            // In the languages of Gwyddion.
            "width",
            "breite",
            "largeur",
            "larghezza",
            "ancho",
            "largura",
            "šířka",
            "ширина",
            "xsize",
            "sizex",
            "xreal",
            "xlength",
            "lengthx",
            "xrange",
            "rangex",
            "xscansize",
            "scansizex",
            "xscanrange",
            "scanrangex",
            "scanwidth",
            "xamplitude",
            "fieldofviewx",
            "xfieldofview",
            "xdimension",
            "dimensionx",
            "xextent",
            "extentx",
            "lx",
        ],
    ),
    (
        Name::Side(1),
        &[
            "height",
            "höhe",
            "hauteur",
            "altezza",
            "alto",
            "altura",
            "výška",
            "высота",
            "ysize",
            "sizey",
            "yreal",
            "ylength",
            "lengthy",
            "yrange",
            "rangey",
            "yscansize",
            "scansizey",
            "yscanrange",
            "scanrangey",
            "scanheight",
            "yamplitude",
            "fieldofviewy",
            "yfieldofview",
            "ydimension",
            "dimensiony",
            "yextent",
            "extenty",
            "ly",
        ],
    ),
    (Name::Sides, &["scansize", "scanrange", "fieldofview", "scanarea", "measuredarea", "measurementarea"]),
    (
        Name::Spacing(0),
        &[
            "xresolution",
            "resolutionx",
            "pixelsizex",
            "xpixelsize",
            "pixelwidth",
            "xpixelwidth",
            "xspacing",
            "spacingx",
            "xstep",
            "stepx",
            "xpitch",
            "pitchx",
            "pixelpitchx",
            "xpixelpitch",
            "dx",
            "deltax",
            "xdelta",
            "xincrement",
            "incrementx",
            "xstepsize",
            "stepsizex",
            "xinterval",
            "intervalx",
            "xsampling",
            "samplingx",
            "lateralresolutionx",
            "xlateralresolution",
            "pixelspacingx",
            "xpixelspacing",
            "xcalibration",
            "pointspacingx",
            "samplespacingx",
            "xscale",
            "scalex",
            "spacinginx",
            "cellsizex",
        ],
    ),
    (
        Name::Spacing(1),
        &[
            "yresolution",
            "resolutiony",
            "pixelsizey",
            "ypixelsize",
            "pixelheight",
            "ypixelheight",
            "yspacing",
            "spacingy",
            "ystep",
            "stepy",
            "ypitch",
            "pitchy",
            "pixelpitchy",
            "ypixelpitch",
            "dy",
            "deltay",
            "ydelta",
            "yincrement",
            "incrementy",
            "ystepsize",
            "stepsizey",
            "yinterval",
            "intervaly",
            "ysampling",
            "samplingy",
            "lateralresolutiony",
            "ylateralresolution",
            "pixelspacingy",
            "ypixelspacing",
            "ycalibration",
            "pointspacingy",
            "samplespacingy",
            "yscale",
            "scaley",
            "spacinginy",
            "cellsizey",
        ],
    ),
    (
        Name::Spacings,
        &[
            "pixelsize",
            "pixelpitch",
            "pitch",
            "pixelspacing",
            "lateralresolution",
            "spacing",
            "pointspacing",
            "samplespacing",
            "gridspacing",
            "gridstep",
            "stepsize",
            "stepwidth",
            "samplinginterval",
            "samplingstep",
            "samplingdistance",
            "cellsize",
            "xycalibration",
            "xyresolution",
            "xyspacing",
            "xypixelsize",
            "lateralsampling",
            "lateralspacing",
            "lateralpixelsize",
            "pixelresolution",
            "resolution",
            "dxy",
        ],
    ),
    (
        Name::Count(0),
        &[
            "w",
            "nx",
            "ncols",
            "ncol",
            "numcols",
            "columns",
            "cols",
            "numberofcolumns",
            "numcolumns",
            "pixelsx",
            "xpixels",
            "numpixelsx",
            "numxpixels",
            "pixelsinx",
            "sampsline",
            "samplesline",
            "sampsperline",
            "samplesperline",
            "pixelsperline",
            "pointsperline",
            "xpoints",
            "pointsx",
            "numpointsx",
            "numberofpointsx",
            "numberofpixelsx",
            "xres",
            "xdatapoints",
            "horizontal",
        ],
    ),
    (
        Name::Count(1),
        &[
            "h",
            "ny",
            "nrows",
            "nrow",
            "numrows",
            "rows",
            "numberofrows",
            "pixelsy",
            "ypixels",
            "numpixelsy",
            "numypixels",
            "pixelsiny",
            "numberoflines",
            "numlines",
            "linesperimage",
            "ypoints",
            "pointsy",
            "numpointsy",
            "numberofpointsy",
            "numberofpixelsy",
            "yres",
            "ydatapoints",
            "vertical",
        ],
    ),
    (
        Name::HeightUnit,
        &[
            "valueunits",
            "valueunit",
            "zunits",
            "zunit",
            "unitz",
            "unitsz",
            "dataunit",
            "dataunits",
            "einheitenderwerte",
            "exportedimageunits",
            "heightunit",
            "heightunits",
            "unitofheights",
            "unitofheight",
            "verticalunit",
            "zaxisunit",
        ],
    ),
    (Name::HeightRange, &["zamplitude"]),
    (Name::Unit, &["unit", "units", "lengthunit", "lengthunits", "unitoflength", "einheit"]),
    (Name::Channel, &["channel", "kanal", "canal", "canale", "kanál", "канал"]),
    (Name::ImageData, &["imagedata"]),
    (
        Name::Missing,
        &[
            "nodatavalue",
            "nodata",
            "missing",
            "missingvalue",
            "missingdatavalue",
            "baddatavalue",
            "badvalue",
            "fillvalue",
            "invalidvalue",
            "invalidpixelvalue",
            "undefinedvalue",
            "voidvalue",
            "nullvalue",
            "badpixelvalue",
            "baddatapointvalue",
        ],
    ),
];

impl Name {
    /// The field called `name`. Its case, and what stands between its words, do not matter.
    pub(super) fn of(name: &str) -> Option<Self> {
        let words: String = name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect();
        if words.starts_with("heightconversionfactor") {
            // The other kind converts to other units.
            return name.to_lowercase().contains("> m").then_some(Self::Metres);
        }
        NAMES.iter().find(|(_, names)| names.contains(&words.as_str())).map(|(name, _)| *name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_known_in_every_case_and_with_anything_between_their_words() {
        for name in
            ["X Resolution", "XResolution", "x_resolution", "Resolution X", "RESOLUTION-X", "Pixel size x", "dx"]
        {
            assert_eq!(Name::of(name), Some(Name::Spacing(0)), "{name}");
        }
        for name in ["NODATA_value", "No data", "Bad data value", "missing value", "NoDataValue"] {
            assert_eq!(Name::of(name), Some(Name::Missing), "{name}");
        }
        assert_eq!(Name::of("height conversion factor (-> m)"), Some(Name::Metres));
        assert_eq!(Name::of("height conversion factor (-> waves)"), None);
        assert_eq!(Name::of("ŠÍŘKA"), Some(Name::Side(0)));
        let all: Vec<&str> = NAMES.iter().flat_map(|(_, names)| names.iter().copied()).collect();
        assert!(all.iter().all(|name| all.iter().filter(|other| *other == name).count() == 1), "a name of two fields");
    }
}
