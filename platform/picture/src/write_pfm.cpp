#include "dicot/os/output_file.h"
#include "dicot/picture/write_picture.h"
#include "writable.h"

#include <bit>
#include <cstdio>

namespace dicot {

Status write_pfm(const char* path, int width, int height, RowSource rows) noexcept
{
    static_assert(std::endian::native == std::endian::little && sizeof(float) == 4);
    TRY(check_writable_size(path, width, height));
    OutputFile file;
    TRY(file.open(path));
    char header[64];
    const int length = std::snprintf(header, sizeof header, "Pf\n%d %d\n-1.0\n", width, height);
    TRY(file.write(header, static_cast<std::size_t>(length)));
    float row[kMaxPictureSide];
    const std::span<float> used{row, static_cast<std::size_t>(width)};
    for (int y = height - 1; y >= 0; --y) {
        rows(y, used);
        TRY(file.write(std::as_bytes(used)));
    }
    return file.commit();
}

} // namespace dicot
