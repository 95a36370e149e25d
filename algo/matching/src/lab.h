// sRGB to CIELAB in integers.
#pragma once

#include "dicot/base/image.h"
#include "dicot/kernels/kernels.h"

#include <cstdint>

namespace dicot::matching {

/// Tables of the conversion. Formats: linear light Q16 (65535 = 1.0); f(t) of CIE 15:2004 eq. 8.4 in Q14.
struct LabTables
{
    std::uint16_t linear[256];
    /// f at t = i / 4096, between which f is taken linearly; t reaches 1.0 exactly at the last but one entry.
    static constexpr int kSteps = 4096;
    std::uint16_t f[kSteps + 2];
};

void fill(LabTables& tables);

/// CIELAB under D65, each channel in steps of 1 / kLabScale, within 0.1 of the real value (held by a test).
struct LabPixel
{
    std::int16_t l, a, b;
};
LabPixel lab_of(Rgb8 colour, const LabTables& tables);

} // namespace dicot::matching
