#include "votes.h"

#include "tables.h"

#include <algorithm>
#include <array>

namespace dicot::matching {
namespace {

/// Neighbours up to this far are asked, one in kStride in each direction; both sides have as many.
constexpr int kReach = 16;
constexpr int kStride = 2;
static_assert(kReach % kStride == 0);

constexpr int kRounds = 2;
/// A majority holds at least so much of the votes, in tenths ...
constexpr int kMajority = 6;
/// ... and there are at least so many votes: seven neighbours of the very same colour.
constexpr std::uint32_t kQuorum = 7 * kLeftWeightOne;

bool certain(Verdict verdict)
{
    return verdict >= Verdict::kVoted;
}

/// The votes of one pixel's neighbours, by whole disparities.
class Ballot
{
public:
    explicit Ballot(int disparities) : bins_(static_cast<std::size_t>(disparities) + 1) {}

    /// Asks the neighbours of (x, y) that are certain of theirs.
    void ask(const Maps& maps, const Planes& left, const ColourWeights& weights, int x, int y)
    {
        std::fill_n(votes_.begin(), bins_, 0u);
        std::fill_n(sums_.begin(), bins_, 0u);
        all_ = 0;
        const LabRow centre = left.lab(y);
        // The first neighbour inside the picture whose distance is a whole number of strides.
        const auto first = [](int at) { return at < kReach ? at % kStride : at - kReach; };
        const int right_end = std::min(x + kReach, maps.disparity.width - 1);
        for (int ny = first(y); ny <= std::min(y + kReach, maps.disparity.height - 1); ny += kStride) {
            const LabRow row = left.lab(ny);
            const Verdict* const verdicts = maps.verdict.row(ny);
            const DispQ8* const values = maps.disparity.row(ny);
            for (int nx = first(x); nx <= right_end; nx += kStride) {
                if (!certain(verdicts[nx]))
                    continue;
                const std::uint32_t weight = weights.between(centre, x, row, nx);
                const DispQ8 value = values[nx];
                const std::size_t bin = static_cast<std::size_t>(value + 128) >> kDispFractionBits;
                votes_[bin] += weight;
                sums_[bin] += std::uint64_t{weight} * value;
                all_ += weight;
            }
        }
    }

    /// The mean of the values that share the most voted whole disparity, or kDispMissing without a majority.
    DispQ8 majority() const
    {
        if (all_ < kQuorum)
            return kDispMissing;
        const auto most = std::max_element(votes_.begin(), votes_.begin() + static_cast<std::ptrdiff_t>(bins_));
        return std::uint64_t{*most} * 10 >= std::uint64_t{all_} * kMajority
                   ? mean(static_cast<std::size_t>(most - votes_.begin()))
                   : kDispMissing;
    }

private:
    DispQ8 mean(std::size_t bin) const { return static_cast<DispQ8>((sums_[bin] + votes_[bin] / 2) / votes_[bin]); }

    std::size_t bins_;
    std::uint32_t all_ = 0; // the votes of a window stay below 2^24
    std::array<std::uint32_t, kMaxDisparities + 1> votes_{};
    std::array<std::uint64_t, kMaxDisparities + 1> sums_{};
};

void vote_in_row(const Maps& maps, int disparities, const Planes& left, const ColourWeights& weights, int y)
{
    const Verdict* const verdicts = maps.verdict.row(y);
    const Verdict* const end = verdicts + maps.disparity.width;
    DispQ8* const elected = maps.scratch.row(y);
    std::fill_n(elected, maps.disparity.width, kDispMissing);
    const Verdict* const first = std::find_if(verdicts, end, certain);
    if (first == end)
        return;
    Ballot ballot(disparities);
    int last = maps.disparity.width - 1;
    while (!certain(verdicts[last]))
        --last;
    for (int x = static_cast<int>(first - verdicts); x < last; ++x) {
        if (certain(verdicts[x]))
            continue;
        ballot.ask(maps, left, weights, x, y);
        elected[x] = ballot.majority();
    }
}

} // namespace

void take_majorities(const Maps& maps, int disparities, const Planes& left, const ColourWeights& weights, Crew& crew)
{
    for (int round = 0; round < kRounds; ++round) {
        crew.run(maps.disparity.height, [&](int y) { vote_in_row(maps, disparities, left, weights, y); });
        for (int y = 0; y < maps.disparity.height; ++y) {
            for (int x = 0; x < maps.disparity.width; ++x) {
                const DispQ8 elected = maps.scratch.row(y)[x];
                if (elected == kDispMissing)
                    continue;
                maps.disparity.row(y)[x] = elected;
                maps.verdict.row(y)[x] = Verdict::kVoted;
            }
        }
    }
}

} // namespace dicot::matching
