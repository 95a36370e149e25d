// The test stand: guarded buffers for one call after another, and the comparison of a kernel with the law.
#pragma once

#include "dice.h"
#include "fault_trap.h"
#include "guarded_area.h"

#include "dicot/base/status.h"
#include "dicot/base/work.h"
#include "dicot/proof/proof.h"

#include <array>
#include <cstddef>
#include <span>

namespace dicot::proof {

/// Where buffers lie in their guarded areas.
enum class Placement
{
    kFirst,  ///< begins where the area begins: nothing can be read before it
    kLast,   ///< ends where the area ends: nothing can be read behind it
    kAskew,  ///< one element behind the begin: aligned to its type and to no more
};
inline constexpr std::array kPlacements = {Placement::kFirst, Placement::kLast, Placement::kAskew};

/// What the buffers are filled with.
enum class Filling
{
    kRandom,
    kZero,
    kLargest,  ///< the largest value of the domain everywhere
    kExtremes, ///< the smallest or the largest value, by dice
};
inline constexpr std::array kFillings = {Filling::kRandom, Filling::kZero, Filling::kLargest, Filling::kExtremes};

const char* word_for(Placement placement);
const char* word_for(Filling filling);

/// A value of 0 .. most as the filling wants it.
std::uint32_t draw(Dice& dice, Filling filling, std::uint32_t most);

/// One output buffer twice: what the law writes and what the kernel under test writes.
template <typename T>
struct Twin
{
    std::span<T> law;
    std::span<T> tested;
};

class Stand
{
public:
    static constexpr std::size_t kAreas = 16;
    static constexpr std::size_t kAreaBytes = std::size_t{1} << 20;

    static Result<Stand> set_up();

    /// Takes all buffers back. What `input` and `output` give next lies as `placement` says.
    void begin(Placement placement);

    /// `count` elements to be filled by the caller; the bytes around them hold noise.
    template <typename T>
    std::span<T> input(std::size_t count)
    {
        return {reinterpret_cast<T*>(place(count * sizeof(T), alignof(T))), count};
    }
    /// Two buffers filled with the same noise, inside and around: what a kernel must leave alone is compared too.
    template <typename T>
    Twin<T> output(std::size_t count)
    {
        const Pair pair = place_twice(count * sizeof(T), alignof(T));
        return {{reinterpret_cast<T*>(pair.law), count}, {reinterpret_cast<T*>(pair.tested), count}};
    }

    /// Runs both; empty when all outputs since `begin` agree byte by byte, else the difference in words.
    const char* difference(TaskRef law, TaskRef tested);
    /// Runs one on the tested side; empty when it touched nothing but its buffers.
    const char* trespass(TaskRef tested);

private:
    struct Pair
    {
        std::byte* law;
        std::byte* tested;
    };
    struct Compared
    {
        std::span<const std::byte> law, tested; // with the noise around
        std::ptrdiff_t offset;                  // of the buffer itself
    };

    Stand() = default;
    std::byte* place(std::size_t bytes, std::size_t alignment);
    Pair place_twice(std::size_t bytes, std::size_t alignment);

    std::array<GuardedArea, kAreas> areas_;
    std::size_t areas_used_ = 0;
    std::array<Compared, kAreas> outputs_{};
    std::size_t outputs_used_ = 0;
    Placement placement_ = Placement::kFirst;
    char words_[160] = {};
};

/// The fastest of several measured runs: `units` per second, where step(0) does `units` of work.
double best_rate(double units, TaskRef step);

/// Notes the first fault of a verdict, in printf's words.
void note_fault(Verdict& verdict, const char* format, ...) __attribute__((format(printf, 2, 3)));

} // namespace dicot::proof
