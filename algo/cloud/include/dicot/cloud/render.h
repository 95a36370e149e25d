// Pictures of a cloud from where no camera stood.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/base/cloud.h"
#include "dicot/base/image.h"

namespace dicot {

/// A place on a sphere around the cloud's median point, looking at it. 0, 0 is the direction of the left camera.
struct Viewpoint
{
    double yaw_deg = 0;   ///< positive: the viewer moves to the right of the cameras
    double pitch_deg = 0; ///< positive: the viewer rises
};

/// Takes what render_cloud() needs for a picture of width x height.
void lay_out_render(Arena& arena, int width, int height);

/// Draws the points as small squares, each as large as the patch of the scene that its pixel saw (`focal_px` is the
/// focal length of the rig), nearer over farther, with edges darkened where the depth jumps. The picture frames the
/// middle 98 % of the cloud. For people: drawn in floating point, and not the same to the last bit on every CPU.
void render_cloud(const PointCloud& cloud, double focal_px, const Viewpoint& from, ImageView<Rgb8> into,
                  Arena& scratch);

/// Two viewpoints side by side, each in half of `into`: from the left, and from the upper right. `scratch` as laid out
/// for (width + 1) / 2 x height.
void render_two_views(const PointCloud& cloud, double focal_px, ImageView<Rgb8> into, Arena& scratch);

} // namespace dicot
