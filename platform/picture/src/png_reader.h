// One PNG file through libpng, whose errors jump.
#pragma once

#include "byte_source.h"
#include "dicot/base/status.h"

#include <png.h>

#include <csetjmp>

namespace dicot {

/// All that lives across libpng's jumps out of an error; the jumps cross no frame with a destructor to run.
struct PngReader
{
    ByteSource& source;
    png_structp png = nullptr;
    png_infop info = nullptr;
    Status why;
    std::jmp_buf escape;
};

/// Ends the reading with `why`.
[[noreturn]] void leave(PngReader& reader, const Status& why) noexcept;

/// Reads the header, calls `body`, and frees what libpng took. The body may leave(), and must hold nothing that has to
/// be destroyed.
Status read_png(ByteSource& source, void (*body)(PngReader& reader, void* context), void* context) noexcept;

} // namespace dicot
