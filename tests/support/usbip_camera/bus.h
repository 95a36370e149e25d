// The bandwidth that the cameras of one bus share, as a host controller would ration it.
#pragma once

#include <map>
#include <string>

namespace dicot::usbip {

class Bus
{
public:
    /// `budget` in bytes a microframe; 0: no limit.
    explicit Bus(int budget) : budget_(budget) {}

    /// Replaces what `who` has; false, and nothing changes, when it does not fit beside the others.
    bool reserve(const std::string& who, int bytes_a_microframe)
    {
        int others = 0;
        for (const auto& [name, bytes] : reserved_)
            others += name == who ? 0 : bytes;
        if (budget_ > 0 && bytes_a_microframe > 0 && others + bytes_a_microframe > budget_)
            return false;
        reserved_[who] = bytes_a_microframe;
        return true;
    }

private:
    int budget_;
    std::map<std::string, int> reserved_;
};

} // namespace dicot::usbip
