// Pixels out of a frame: the one place where its bytes are read as colours.
#pragma once

#include "dicot/base/image.h"
#include "dicot/base/status.h"
#include "dicot/camera/frame.h"

namespace dicot {

/// Decodes a whole frame into `into`, which has the frame's size. Integers only: the same bytes give the same pixels
/// on every CPU, so a recorded YUYV frame and its decoded PNG lead to the same cloud.
///
/// - YUYV, NV12: BT.601 (SMPTE 170M), limited range: black is Y 16, white Y 235, chroma 128 +- 112. That is UVC's
/// default
///   where a device has no colour matching descriptor (UVC 1.5, 3.9.2.6) and V4L2's for YCbCr. With y = Y - 16,
///   u = U - 128, v = V - 128, in 1/65536 and rounded to the nearest, halves up, then held to 0 .. 255:
///   R = 76309 y + 104597 v, G = 76309 y - 25675 u - 53279 v, B = 76309 y + 132201 u.
///   Each U, V pair stands for its two (YUYV) or four (NV12) pixels as it is: no interpolation.
/// - GREY: r = g = b = the byte, full range: infrared and machine-vision cameras use all 8 bits.
/// - RGB24: copied.
/// - MJPEG: as read_picture() decodes JPEG (BT.601, full range, as JFIF says, exact integer IDCT), Huffman tables of
///   ITU T.81 annex K where a frame has none, as webcams leave them out.
///
/// Fault::kBadData: the frame is torn or cancelled, its bytes are not exactly those of its mode, the mode has an odd
/// width (YUYV, NV12) or height (NV12), `into` has another size, the JPEG is damaged or has another size. After a
/// failure `into` is unspecified. No heap; libjpeg takes its rows from malloc.
Status decode_frame(const Frame& frame, ImageView<Rgb8> into) noexcept;

/// Whether the bytes of a frame can be those of its mode; decode_frame() and luma_of() ask it first.
Status check_frame(const Frame& frame) noexcept;

} // namespace dicot
