// Depths on the pixels of the left picture as the camera gave it, true and measured.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace dicot::test {

/// What a pixel shows (gt_class.png of rig-dev).
enum class Kind : std::uint8_t
{
    kBackground,
    kLeaf,
    kStem,
    kPot,
    kSoil,
    kFruit,
    kBench,
    kOtherPlant
};

/// The truth about a rendered picture, row after row.
struct TrueDepth
{
    int width = 0;
    int height = 0;
    std::vector<float> mm; ///< along the left camera's axis; infinite where nothing is
    std::vector<Kind> kind;
    std::vector<bool> seen_by_both;
    std::vector<bool> hidden; ///< from the right camera
    std::vector<bool> leaf;   ///< leaves of this plant that both cameras see

    std::size_t pixels() const { return mm.size(); }
};

/// From a folder of rig-dev/plants, or of another one where `seen` tells what the right camera sees. Stops the program
/// with the reason where it cannot be read.
TrueDepth read_truth(const std::string& folder, const std::string& seen = "gt_visible_right.png");

/// What somebody measured, on the same pixels.
struct RawDepth
{
    std::vector<float> mm;                ///< along the left camera's axis; NaN where there is no value
    std::vector<std::uint8_t> confidence; ///< as DisparityMap's; 0 from those who tell none
};

/// Of the pixels of a mask. Shares in percent; of all pixels, and of those with a value.
struct DepthFigures
{
    long pixels = 0;
    double median_mm = 0; ///< of the error's size, of those with a value
    double bias_mm = 0;   ///< median of the error
    double valued = 0;
    double within_all = 0, within_valued = 0; ///< kWithinMm
    double off_all = 0, off_valued = 0;       ///< kOffMm

    static constexpr double kWithinMm = 3;
    static constexpr double kOffMm = 10;
};

DepthFigures figures_of(const RawDepth& measured, const TrueDepth& truth, const std::vector<bool>& mask);
/// Each figure's mean, the pixels' sum.
DepthFigures mean_of(const std::vector<DepthFigures>& all);

/// One row of the table below its head.
void print_head();
void print_row(const char* name, const char* who, const DepthFigures& figures);

} // namespace dicot::test
