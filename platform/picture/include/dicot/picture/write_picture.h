// Writing pictures and maps: whole and durable, or not at all.
#pragma once

#include "dicot/base/byte_sink.h"
#include "dicot/base/image.h"
#include "dicot/base/status.h"

#include <cstdint>
#include <span>
#include <type_traits>

namespace dicot {

/// Fault::kCannotCreate and kIoError as OutputFile says; the file's name is not looked at for the format.
/// Pictures are 1 .. kMaxPictureSide (read_picture.h) on a side.
Status write_png(const char* path, ImageView<const Rgb8> picture) noexcept;
/// To wherever `sink` leads; `name` stands for it in sentences. Errors: the sink's.
Status write_png(ByteSink& sink, const char* name, ImageView<const Rgb8> picture) noexcept;
/// Grey, 16 bits.
Status write_png16(const char* path, ImageView<const std::uint16_t> picture) noexcept;
/// Baseline JPEG, 4:2:0, `quality` 1 .. 100.
Status write_jpeg(const char* path, ImageView<const Rgb8> picture, int quality) noexcept;
Status write_jpeg(ByteSink& sink, const char* name, ImageView<const Rgb8> picture, int quality) noexcept;

/// A borrowed callable `void(int y, std::span<float> row)` that fills row y, 0 at the top, of a map.
class RowSource
{
public:
    // clang-format off
    template <typename F>
        requires(!std::is_same_v<std::remove_cvref_t<F>, RowSource>)
    RowSource(F&& fill) noexcept // NOLINT(google-explicit-constructor,bugprone-forwarding-reference-overload)
        : object_(const_cast<void*>(static_cast<const void*>(&fill))),
          call_([](void* object, int y, std::span<float> row) {
              (*static_cast<std::remove_reference_t<F>*>(object))(y, row);
          })
    {
    }
    // clang-format on
    void operator()(int y, std::span<float> row) const { call_(object_, y, row); }

private:
    void* object_;
    void (*call_)(void*, int, std::span<float>);
};

/// PFM, one channel: "Pf", float32, little-endian (scale -1), bottom row first; a missing value is +infinity.
/// `rows` is asked for each row once, from the bottom up, and fills all `width` values.
Status write_pfm(const char* path, int width, int height, RowSource rows) noexcept;

} // namespace dicot
