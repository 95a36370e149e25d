// The words of the program's command line.
#pragma once

#include "dicot/base/status.h"

#include "model.h"

#include <span>
#include <string>
#include <vector>

namespace dicot::usbip {

struct CameraWish
{
    CameraModel model; ///< without formats: they come from the frames
    std::string frames;
    int port = 0;
};

struct Options
{
    std::vector<CameraWish> cameras;
    int bus_bytes = 0;
    std::string plan;
    std::string commands;
    bool descriptors_only = false;
};

/// Fault::kUsage with the word that is wrong. The words are in README.md.
Result<Options> read_options(std::span<const char* const> words);

} // namespace dicot::usbip
