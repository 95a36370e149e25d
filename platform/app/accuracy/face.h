// The part of a rectified picture that a target covers, and how far away the matcher sees it.
#pragma once

#include "target_list.h"

#include "dicot/base/cloud.h"
#include "dicot/base/disparity.h"
#include "dicot/base/stereo_rig.h"
#include "dicot/cloud/working_range.h"

#include <optional>
#include <span>

namespace dicot::app {

/// From the left picture as the camera gave it to its rectified one. Of pictures that are rectified already, neither
/// lens nor turn changes anything.
struct LeftView
{
    std::optional<Lens> lens;                    ///< none: the pictures are rectified
    Turn from_camera{1, 0, 0, 0, 1, 0, 0, 0, 1}; ///< R1
    RigGeometry rig;

    /// Nothing where the lens cannot be undone.
    std::optional<Point2> rectified(Point2 pixel) const;
    /// The direction of a rectified pixel in the frame of the camera, as long as its rectified depth is 1.
    Point3 direction(double x, double y) const;
};

/// Columns first .. end - 1 and rows top .. bottom - 1.
struct PictureRange
{
    int first = 0, end = 0, top = 0, bottom = 0;
    int width() const { return end - first; }
    int height() const { return bottom - top; }
};

/// A convex part of the rectified left picture.
class Face
{
public:
    /// Fault::kBadData: the corners cannot be rectified, or less than kLeastPixels of the face lie in the picture.
    static Result<Face> of(const Target& target, const LeftView& view);

    static constexpr int kLeastPixels = 30;

    bool contains(int x, int y) const;
    const PictureRange& bounds() const { return bounds_; } ///< within the picture

private:
    std::array<Point2, 4> corners_{};
    PictureRange bounds_;
};

/// What must be matched so that the face comes out as if the whole picture were: the partners of its pixels at every
/// disparity, and room for what the matcher looks at around it. The right picture's part has the same size and begins
/// `search.min_disparity` px further left.
PictureRange matched_part(const Face& face, const RigGeometry& rig, const DisparityRange& search);

/// Depths along the optical axis of the left camera, of the pixels of a face.
struct FaceDepth
{
    int pixels = 0;          ///< of the face
    int valued = 0;          ///< of these, with a disparity
    double measured_mm = 0;  ///< median; of a slanted target, where its middle is by the median of the errors
    double error_mm = 0;     ///< median of measured minus true
    double spread_mm = 0;    ///< half of the pixels lie within this of the median
    double point_mm = 0;     ///< 95 of 100 pixels are off by this at most
    double disparity_px = 0; ///< true one, median
    double valued_share() const { return pixels == 0 ? 0 : static_cast<double>(valued) / pixels; }
};

/// Measures; without a valued pixel the lengths are 0. `map` is that of `part`, its min_disparity 0 where the right
/// part begins `search.min_disparity` px to the left.
FaceDepth measure(const Target& target, const Face& face, const LeftView& view, const PictureRange& part,
                  const DisparityRange& search, const DisparityMap& map);

/// The paper's eq. 21: by how much a depth is off when its disparity is off by `off_px`,
///     dZ = Z^2 / (f B) * off_px,
/// Z in mm, f in px and B in mm of the rectified pair: the derivative of Z = f B / d (eq. 16). With kStepPx, half a
/// step, it is the most that is lost by disparities which are whole px: the bound of a matcher without sub-pixel.
double depth_bound_mm(const RigGeometry& rig, double distance_mm, double off_px);
inline constexpr double kStepPx = 0.5;

} // namespace dicot::app
