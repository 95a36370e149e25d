// The pictures of the report: small copies of the pairs and one pair with parallel rows, and what is drawn over them.
#pragma once

#include "report_measures.h"

#include <string>
#include <string_view>

namespace dicot::app {

/// A picture of the report, or why there is none.
struct ReportPicture
{
    std::string file; ///< name in the report's folder; empty when there is none
    std::string missing;
    int width = 0; ///< px, as written
    int height = 0;
};

/// Names of a pair's two small pictures.
struct PairPictures
{
    ReportPicture left;
    ReportPicture right;
};

/// Writes `pair-<number>-left.jpg` and `-right.jpg`, at most kThumbnailWidth wide. A picture that cannot be read again
/// is `missing`; what cannot be written is a failure.
Result<PairPictures> write_thumbnails(const SeenPair& pair, std::size_t number, const std::string& folder);
constexpr int kThumbnailWidth = 480;

/// Writes rectified-left.jpg and rectified-right.jpg. A pair that cannot be rectified is `missing`.
Result<PairPictures> write_rectified(const CalibrationRun& run, const SeenPair& pair, const std::string& folder);
constexpr int kRectifiedWidth = 800;

/// The small picture with its corners: coloured and joined row by row, the first one filled.
std::string corner_drawing(const ReportPicture& picture, const std::string& label, const CalibrationRun& run,
                           const calibration::BoardSight& sight, int board);

/// Both rectified pictures side by side under horizontal lines, the corners of the pair marked.
std::string rectified_drawing(const CalibrationRun& run, const Rectification& flat, const SeenPair& pair,
                              const PairPictures& pictures);

} // namespace dicot::app
