// From the root to a place below it, part by part, so that nothing on the way leads elsewhere.
#pragma once

#include "dicot/medium/medium.h"

#include <climits>
#include <string_view>

namespace dicot {

/// Closed when it goes.
class Descriptor
{
public:
    Descriptor() noexcept = default;
    explicit Descriptor(int number) noexcept : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
    Descriptor& operator=(Descriptor&& other) noexcept;
    ~Descriptor();

    bool ok() const noexcept { return number_ >= 0; }
    int number() const noexcept { return number_; }
    int release() noexcept;

private:
    int number_ = -1;
};

/// A name in a folder that is held open.
struct Place
{
    Descriptor folder; ///< good for names alone (O_PATH)
    char name[NAME_MAX + 1] = {};
};

/// The folder around `path`, and the last part. EINVAL for "", and for what is no path of a Medium.
Errno find_place(int root, std::string_view path, Place& place) noexcept;
/// The folder `path` itself, to be listed or synced; "" is the root.
Errno open_folder(int root, std::string_view path, Descriptor& folder) noexcept;

} // namespace dicot
