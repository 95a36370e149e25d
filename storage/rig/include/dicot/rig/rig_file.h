// The rig file: what a calibration knows about two cameras, in the words of OpenCV's FileStorage (storage/FORMAT.md).
#pragma once

#include "dicot/base/cloud.h"
#include "dicot/base/status.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace dicot {

inline constexpr std::size_t kMaxRigFileBytes = std::size_t{1} << 20;
inline constexpr int kMaxRigPictureSide = 16384;

template <std::size_t Rows, std::size_t Columns>
using Matrix = std::array<std::array<double, Columns>, Rows>;

/// k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 tx ty: as many as are known (4, 5, 8, 12 or 14), the rest 0.
struct Distortion
{
    static constexpr int kMost = 14;
    int count = 0;
    std::array<double, kMost> at{};

    friend bool operator==(const Distortion&, const Distortion&) = default;
};

struct RigCamera
{
    std::optional<Matrix<3, 3>> intrinsic;  ///< K1, K2: px
    std::optional<Distortion> distortion;   ///< D1, D2
    std::optional<Matrix<3, 3>> rectifying; ///< R1, R2: rectified from camera
    std::optional<Matrix<3, 4>> projection; ///< P1, P2: px, last column px mm

    friend bool operator==(const RigCamera&, const RigCamera&) = default;
};

/// What 'dicot calibrate' found out about its own result (algo/calibration/README.md says what each number means).
struct RigQuality
{
    static constexpr std::size_t kVerdictBytes = 15;
    static constexpr std::array<int, 3> kDepthsMm{500, 800, 1000};

    char verdict[kVerdictBytes + 1] = {}; ///< good, usable, redo
    int pairs = 0;                        ///< used
    double rms_px = 0;                    ///< distance between seen and predicted corners
    double epipolar_rms_px = 0;
    double epipolar_p95_px = 0;
    double held_out_mm = 0;                 ///< shape of the boards that a solution without them triangulates
    double held_out_depth_mm = 0;           ///< their size, times their distance
    std::array<double, 3> depth_error_mm{}; ///< standard deviation expected at kDepthsMm
    double nearest_mm = 0;                  ///< corners
    double farthest_mm = 0;

    friend bool operator==(const RigQuality&, const RigQuality&) = default;
};

/// Lengths are in mm, whatever the file's unit. x_right = rotation * x_left + translation_mm.
struct RigFile
{
    static constexpr std::size_t kIdBytes = 64;
    static constexpr std::size_t kTimeBytes = 20; // 2026-03-01T12:00:00Z

    char id[kIdBytes + 1] = {};              ///< letters, digits and -_.:+ ; empty when the file names none
    char calibrated_at[kTimeBytes + 1] = {}; ///< ISO 8601, UTC; empty when the file names no time
    int width = 0;                           ///< px, of each picture
    int height = 0;
    RigCamera left;
    RigCamera right;
    std::optional<Matrix<3, 3>> rotation;                ///< R
    std::optional<std::array<double, 3>> translation_mm; ///< T
    std::optional<Matrix<4, 4>> reprojection;            ///< Q: mm from px
    std::optional<double> near_mm;
    std::optional<double> far_mm;
    std::optional<RigQuality> quality;

    friend bool operator==(const RigFile&, const RigFile&) = default;
};

/// Reads a rig file from bytes that may come from anywhere; `name` stands in the sentences. Every number is finite,
/// every matrix has its shape, image_width and image_height are there and sane, near is below far; nothing else is
/// required yet. Fault::kBadData otherwise.
Result<RigFile> parse_rig(std::span<const std::byte> text, const char* name);

/// What a person knows about a file that does not say it itself. Where both say it, they must agree.
struct RigHints
{
    int width = 0; ///< px, of each picture; 0: not known
    int height = 0;
    double mm_per_unit = 0; ///< of the file's lengths; 0: not known, mm are assumed
};

/// Reads the file at `path`. Fault::kNoInput: missing or unreadable. Allocates: for start-up only.
Result<RigFile> read_rig_file(const char* path, const RigHints& hints = {});

/// Writes `rig` with full precision, unit mm: reading it again gives the same values. Durable or absent.
/// Fault::kBadData: a number is not finite (it is named by its key), nothing is written.
Status write_rig_file(const char* path, const RigFile& rig);

/// The geometry of the rectified pictures, out of P1 and P2. Fault::kBadData: P1 or P2 missing, or not those of a
/// horizontal rectified pair (different focal lengths or rows, cameras above each other), or the cameras are swapped.
Result<RigGeometry> geometry_of(const RigFile& rig, const char* name);

} // namespace dicot
