#include "rig_reader.h"

#include "dicot/base/utc_time.h"
#include "rig_quality.h"
#include "rig_values.h"
#include "rotation_vector.h"

#include "dicot/os/input_file.h"
#include "dicot/os/shown_path.h"

#include <cmath>
#include <cstring>
#include <new>
#include <vector>

namespace dicot {
namespace {

using Kind = YamlEvents::Kind;
constexpr double kMmPerMetre = 1000.0;

Status too_large(const char* name)
{
    return failure(Fault::kBadData, "%s: a rig file has 1 MiB at most: give the file that the calibration wrote",
                   shown_path(name));
}

template <typename Read>
Status once(YamlEvents& events, bool first, std::string_view key, Read read)
{
    return first ? read() : wrong_value(events, key, "there once only");
}

template <typename Value, typename Read>
Status once_into(YamlEvents& events, std::string_view key, std::optional<Value>& into, Read read)
{
    return once(events, !into, key, [&]() -> Status {
        into = TRY(read(events, key));
        return {};
    });
}

bool is_id_letter(char c)
{
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           (c != '\0' && std::strchr("-_.:+", c) != nullptr);
}

} // namespace

Status RigReader::take_text(std::span<const std::byte> text, const char* name)
{
    if (text.size() > kMaxRigFileBytes)
        return too_large(name);
    YamlEvents events{text, name};
    if (events.kind() != Kind::kMapStart)
        return events.status().ok() ? events.fault("no rig's description: keys and values are expected")
                                    : events.status();
    events.next();
    while (events.kind() == Kind::kScalar) {
        const KeyText key{events.scalar()};
        events.next();
        TRY(take_key(events, key.text()));
    }
    if (events.kind() != Kind::kMapEnd)
        return events.status().ok() ? events.fault("a key is expected") : events.status();
    events.next();
    return events.status();
}

Status RigReader::take_file(const char* path)
{
    InputFile file;
    TRY(file.open(path));
    if (file.size_bytes() > kMaxRigFileBytes)
        return too_large(path);
    try {
        std::vector<std::byte> text(static_cast<std::size_t>(file.size_bytes()));
        const std::size_t read = TRY(file.read(text));
        return take_text(std::span{text}.first(read), path);
    } catch (const std::bad_alloc&) {
        return failure(Fault::kOsError, "%s: no memory to read it", shown_path(path));
    }
}

Status RigReader::take_key(YamlEvents& events, std::string_view key)
{
    const auto whole = [&](int& into) {
        return once(events, into == 0, key, [&]() -> Status {
            into = TRY(read_whole(events, key));
            return {};
        });
    };
    if (key == "image_width" || key == "image_Width")
        return whole(rig_.width);
    if (key == "image_height" || key == "image_Height")
        return whole(rig_.height);
    if (key == "imageSize" || key == "image_size")
        return once(events, rig_.width == 0 && rig_.height == 0, key,
                    [&] { return read_size(events, key, rig_.width, rig_.height); });
    if (key == "K1" || key == "M1" || key == "camera_matrix" || key == "Camera_Matrix")
        return read_shaped(events, key, rig_.left.intrinsic, "3 x 3");
    if (key == "K2" || key == "M2")
        return read_shaped(events, key, rig_.right.intrinsic, "3 x 3");
    if (key == "D1" || key == "distortion_coefficients" || key == "Distortion_Coefficients")
        return once_into(events, key, rig_.left.distortion, read_distortion);
    if (key == "D2")
        return once_into(events, key, rig_.right.distortion, read_distortion);
    if (key == "R")
        return read_shaped(events, key, rig_.rotation, "3 x 3");
    if (key == "om")
        return take_rotation_vector(events, key);
    if (key == "T")
        return once_into(events, key, rig_.translation_mm, read_vector);
    if (key == "R1")
        return read_shaped(events, key, rig_.left.rectifying, "3 x 3");
    if (key == "R2")
        return read_shaped(events, key, rig_.right.rectifying, "3 x 3");
    if (key == "P1")
        return read_shaped(events, key, rig_.left.projection, "3 x 4");
    if (key == "P2")
        return read_shaped(events, key, rig_.right.projection, "3 x 4");
    if (key == "Q")
        return read_shaped(events, key, rig_.reprojection, "4 x 4");
    if (key == "near_mm")
        return once_into(events, key, rig_.near_mm, read_number);
    if (key == "far_mm")
        return once_into(events, key, rig_.far_mm, read_number);
    if (key == "quality")
        return once_into(events, key, rig_.quality, read_quality);
    if (key == "unit")
        return take_unit(events, key);
    if (key == "id")
        return take_id(events, key);
    if (key == "calibration_time")
        return take_time(events, key);
    events.skip_value();
    return events.status();
}

Status RigReader::take_rotation_vector(YamlEvents& events, std::string_view key)
{
    if (rig_.rotation)
        return wrong_value(events, key, "there once only, and without R");
    const auto vector = TRY(read_vector(events, key));
    if (!(std::sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2]) <= kLongestTurn))
        return wrong_value(events, key, "a turn in radians, by half a circle at most");
    rig_.rotation = matrix_of_rotation(vector);
    return {};
}

Status RigReader::take_unit(YamlEvents& events, std::string_view key)
{
    if (mm_per_unit_ != 0 || events.kind() != Kind::kScalar || (events.scalar() != "mm" && events.scalar() != "m"))
        return wrong_value(events, key, mm_per_unit_ != 0 ? "there once only" : "mm or m");
    mm_per_unit_ = events.scalar() == "m" ? kMmPerMetre : 1.0;
    events.next();
    return {};
}

Status RigReader::take_id(YamlEvents& events, std::string_view key)
{
    const std::string_view text = events.scalar();
    bool fits = events.kind() == Kind::kScalar && text.size() <= RigFile::kIdBytes && rig_.id[0] == '\0';
    for (const char c : text)
        fits = fits && is_id_letter(c);
    if (!fits)
        return wrong_value(events, key, "one word of 64 letters, digits or -_.:+ at most");
    text.copy(rig_.id, RigFile::kIdBytes);
    events.next();
    return {};
}

/// OpenCV's samples put the words of strftime's %c there, in somebody's language: those are passed over.
Status RigReader::take_time(YamlEvents& events, std::string_view key)
{
    if (events.kind() != Kind::kScalar || rig_.calibrated_at[0] != '\0')
        return wrong_value(events, key, "one time, there once only");
    const std::string_view text = events.scalar();
    if (is_utc_time(text))
        text.copy(rig_.calibrated_at, RigFile::kTimeBytes);
    else if (begins_as_utc_time(text))
        return wrong_value(events, key, "a time in UTC, as 2026-03-01T12:00:00Z");
    events.next();
    return {};
}

Result<RigFile> RigReader::finish(const char* name)
{
    TRY(take_hints(name));
    if (mm_per_unit_ != 1.0)
        TRY(to_mm(name));
    TRY(check(name));
    return rig_;
}

Status RigReader::take_hints(const char* name)
{
    const char* path = shown_path(name);
    if (hints_.width != 0) {
        if (rig_.width == 0 && rig_.height == 0) {
            rig_.width = hints_.width;
            rig_.height = hints_.height;
        }
        if (rig_.width != hints_.width || rig_.height != hints_.height)
            return failure(Fault::kBadData,
                           "%s: is for pictures of %d x %d px, and %d x %d were given: leave the size to the file",
                           path, rig_.width, rig_.height, hints_.width, hints_.height);
    }
    if (hints_.mm_per_unit != 0) {
        if (mm_per_unit_ != 0 && mm_per_unit_ != hints_.mm_per_unit)
            return failure(Fault::kBadData,
                           "%s: says that its unit has %g mm, and %g mm were given: leave the unit to the file", path,
                           mm_per_unit_, hints_.mm_per_unit);
        mm_per_unit_ = hints_.mm_per_unit;
    }
    if (mm_per_unit_ == 0)
        mm_per_unit_ = 1.0;
    return {};
}

Status RigReader::to_mm(const char* name)
{
    const auto scale = [&](const char* key, double& length, double factor) -> Status {
        length *= factor;
        return std::isfinite(length) ? Status{}
                                     : failure(Fault::kBadData, "%s: a length in %s is too large for any rig: mend it",
                                               shown_path(name), key);
    };
    if (rig_.translation_mm)
        for (double& length : *rig_.translation_mm)
            TRY(scale("T", length, mm_per_unit_));
    for (auto& [key, camera] : {std::pair{"P1", &rig_.left}, std::pair{"P2", &rig_.right}})
        if (camera->projection)
            for (auto& row : *camera->projection)
                TRY(scale(key, row[3], mm_per_unit_));
    if (rig_.reprojection)
        for (double& per_length : (*rig_.reprojection)[3])
            TRY(scale("Q", per_length, 1 / mm_per_unit_));
    return {};
}

Status RigReader::check(const char* name) const
{
    const char* path = shown_path(name);
    if (rig_.width == 0 || rig_.height == 0)
        return failure(Fault::kBadData,
                       "%s: image_width or image_height is missing or 0: add the size that the cameras were "
                       "calibrated with, or give it with 'dicot rig convert --size'",
                       path);
    if (rig_.width < 1 || rig_.height < 1 || rig_.width > kMaxRigPictureSide || rig_.height > kMaxRigPictureSide)
        return failure(Fault::kBadData,
                       "%s: image_width x image_height is %d x %d, and each must be 1 to %d: mend the file "
                       "or calibrate again",
                       path, rig_.width, rig_.height, kMaxRigPictureSide);
    const bool range_known = rig_.near_mm && rig_.far_mm;
    if ((rig_.near_mm && !(*rig_.near_mm > 0)) || (rig_.far_mm && !(*rig_.far_mm > 0)) ||
        (range_known && !(*rig_.far_mm > *rig_.near_mm)))
        return failure(Fault::kBadData,
                       "%s: near_mm and far_mm must be above 0, and far_mm above near_mm: mend the file", path);
    if (rig_.quality && rig_.quality->farthest_mm < rig_.quality->nearest_mm)
        return failure(Fault::kBadData, "%s: quality: farthest_mm must not be below nearest_mm: mend the file", path);
    return {};
}

Result<RigFile> parse_rig(std::span<const std::byte> text, const char* name)
{
    RigReader reader{RigHints{}};
    TRY(reader.take_text(text, name));
    return reader.finish(name);
}

Result<RigFile> read_rig_file(const char* path, const RigHints& hints)
{
    RigReader reader{hints};
    TRY(reader.take_file(path));
    return reader.finish(path);
}

} // namespace dicot
