// Pictures of a cloud on the grid that it was seen on.
#pragma once

#include "dicot/base/image.h"
#include "dicot/base/status.h"
#include "dicot/plant/plant_view.h"

#include <string>
#include <vector>

namespace dicot::app {

/// A decoded picture together with its memory.
struct OwnPicture
{
    std::vector<Rgb8> pixels;
    ImageView<Rgb8> view;

    OwnPicture(int width, int height);
    OwnPicture(OwnPicture&&) = default;
    OwnPicture& operator=(OwnPicture&&) = default;
    /// Errors: read_picture_bytes()'s.
    static Result<OwnPicture> decode(const std::string& file, const char* name);
};

/// Where the grid of a view lies in the picture that its camera saw: column and row of its first cell.
struct GridPlace
{
    int width = 0; ///< of the picture, px
    int height = 0;
    int column = 0;
    int row = 0;
};

/// The place where the points' colours are those of the picture's pixels. A picture that is smaller than the grid is
/// none: then the grid is the picture.
GridPlace place_in_picture(const PlantView& view, ImageView<const Rgb8> picture);
GridPlace place_of_its_own(const PlantView& view);

/// The colours of the points on their grid, dark grey where there is none.
OwnPicture picture_of(const PlantView& view);
/// Disparities as paint_disparities() paints them. They are told by the distances alone, so their unit is not px.
OwnPicture disparity_of(const PlantView& view, const GridPlace& place);
/// A picture about `width` px wide: means of whole blocks.
OwnPicture smaller(ImageView<const Rgb8> picture, int width);

/// Files as strings; the size of a picture is at most kMaxPictureSide.
std::string jpeg_of(ImageView<const Rgb8> picture);
std::string png_of(ImageView<const Rgb8> picture);

} // namespace dicot::app
