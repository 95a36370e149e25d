// The files of a mounted FunctionFS, open.
#pragma once

#include "dicot/base/status.h"

#include <utility>

namespace dicot::gadget_parts {

class Descriptor
{
public:
    Descriptor() noexcept = default;
    explicit Descriptor(int number) noexcept : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept
    {
        std::swap(number_, other.number_);
        return *this;
    }
    ~Descriptor();

    int get() const noexcept { return number_; }

private:
    int number_ = -1;
};

struct Endpoints
{
    Descriptor control, to_host, from_host, events; ///< let go, all together end the function

    /// Hands over descriptors and strings. Errors: those of FfsLink::open().
    static Result<Endpoints> open(const char* mount) noexcept;
    /// Of the bulk endpoint that a host has configured, bytes; 512 if the kernel does not tell.
    unsigned packet_bytes() const noexcept;
    void discard_unread() const noexcept; ///< what the controller holds for the host
};

} // namespace dicot::gadget_parts
