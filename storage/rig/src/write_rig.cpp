#include "rig_quality.h"

#include "dicot/os/output_file.h"
#include "dicot/os/shown_path.h"
#include "dicot/rig/rig_file.h"

#include <charconv>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <utility>

namespace dicot {
namespace {

constexpr int kNumbersPerLine = 4;

/// FileStorage's layout; keeps the first fault.
class RigWriter
{
public:
    RigWriter(OutputFile& file, const char* path) : file_(file), path_(path) {}

    void text(const char* format, ...) __attribute__((format(printf, 2, 3)))
    {
        char line[160];
        va_list arguments;
        va_start(arguments, format);
        const int size = std::vsnprintf(line, sizeof line, format, arguments);
        va_end(arguments);
        put(line, static_cast<std::size_t>(size));
    }

    void number(const char* key, double value)
    {
        if (status_.ok() && !std::isfinite(value))
            status_ = failure(Fault::kBadData, "%s: not written, since %s is not finite: calibrate again",
                              shown_path(path_), key);
        char digits[32]; // to_chars, not printf: a locale must not turn the point into a comma
        const auto end = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 17);
        put(digits, static_cast<std::size_t>(end.ptr - digits));
    }

    void matrix(const char* key, int rows, int columns, const double* values)
    {
        text("%s: !!opencv-matrix\n   rows: %d\n   cols: %d\n   dt: d\n   data: [ ", key, rows, columns);
        for (int i = 0; i < rows * columns; ++i) {
            if (i > 0)
                text(i % kNumbersPerLine == 0 ? ",\n       " : ", ");
            number(key, values[i]);
        }
        text(" ]\n");
    }

    void entry(const char* key, double value, const char* indent = "")
    {
        text("%s%s: ", indent, key);
        number(key, value);
        text("\n");
    }

    template <std::size_t Rows, std::size_t Columns>
    void matrix(const char* key, const std::optional<std::array<std::array<double, Columns>, Rows>>& matrix_known)
    {
        if (matrix_known)
            matrix(key, static_cast<int>(Rows), static_cast<int>(Columns), (*matrix_known)[0].data());
    }

    const Status& status() const { return status_; }

private:
    void put(const char* bytes, std::size_t count)
    {
        if (status_.ok())
            status_ = file_.write(bytes, count);
    }

    OutputFile& file_;
    const char* path_;
    Status status_;
};

void write_camera(RigWriter& out, const RigCamera& camera, const char* intrinsic, const char* distortion)
{
    out.matrix(intrinsic, camera.intrinsic);
    if (camera.distortion)
        out.matrix(distortion, 1, camera.distortion->count, camera.distortion->at.data());
}

void write_quality(RigWriter& out, RigQuality quality)
{
    out.text("quality:\n   verdict: \"%s\"\n   pairs: %d\n", quality.verdict, quality.pairs);
    for (const QualityNumber& number : numbers_of(quality))
        out.entry(number.key, *number.at, "   ");
}

} // namespace

Status write_rig_file(const char* path, const RigFile& rig)
{
    OutputFile file;
    TRY(file.open(path));
    RigWriter out{file, path};
    out.text("%%YAML:1.0\n---\n");
    if (rig.id[0] != '\0')
        out.text("id: \"%s\"\n", rig.id);
    if (rig.calibrated_at[0] != '\0')
        out.text("calibration_time: \"%s\"\n", rig.calibrated_at);
    out.text("unit: mm\nimage_width: %d\nimage_height: %d\n", rig.width, rig.height);
    for (const auto& [key, known] : {std::pair{"near_mm", rig.near_mm}, std::pair{"far_mm", rig.far_mm}})
        if (known)
            out.entry(key, *known);
    if (rig.quality)
        write_quality(out, *rig.quality);
    write_camera(out, rig.left, "K1", "D1");
    write_camera(out, rig.right, "K2", "D2");
    out.matrix("R", rig.rotation);
    if (rig.translation_mm)
        out.matrix("T", 3, 1, rig.translation_mm->data());
    out.matrix("R1", rig.left.rectifying);
    out.matrix("R2", rig.right.rectifying);
    out.matrix("P1", rig.left.projection);
    out.matrix("P2", rig.right.projection);
    out.matrix("Q", rig.reprojection);
    TRY(Status{out.status()});
    return file.commit();
}

} // namespace dicot
