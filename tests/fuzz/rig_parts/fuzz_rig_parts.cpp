// Planner, pairing and ladder of two cameras; the first byte chooses.
#include "parts.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace dicot::fuzz;
    Numbers numbers{{data, size}};
    switch (numbers.byte() % 3) {
    case 0:
        plan(numbers);
        break;
    case 1:
        pair(numbers);
        break;
    default:
        climb_ladder(numbers);
    }
    return 0;
}
