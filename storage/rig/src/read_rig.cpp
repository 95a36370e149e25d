#include "rig_values.h"

#include "dicot/os/input_file.h"
#include "dicot/os/shown_path.h"
#include "dicot/rig/rig_file.h"

#include <cstring>
#include <new>
#include <string_view>
#include <vector>

namespace dicot {
namespace {

using Kind = YamlEvents::Kind;
constexpr double kMmPerMetre = 1000.0;

/// One pass over the file's map; keys that it does not know are passed over.
class RigReader
{
public:
    RigReader(YamlEvents& events, const char* name) : events_(events), name_(name) {}

    Result<RigFile> read()
    {
        if (events_.kind() != Kind::kMapStart)
            return events_.status().ok() ? events_.fault("no rig's description: keys and values are expected")
                                         : events_.status();
        events_.next();
        while (events_.kind() == Kind::kScalar) {
            char key[kMostKeyBytes + 1] = {};
            const std::string_view text = events_.scalar();
            if (text.size() <= kMostKeyBytes)
                text.copy(key, kMostKeyBytes);
            events_.next();
            TRY(take(key));
        }
        if (events_.kind() != Kind::kMapEnd)
            return events_.status().ok() ? events_.fault("a key is expected") : events_.status();
        events_.next();
        TRY(Status{events_.status()});
        if (in_metres_)
            to_mm();
        TRY(check());
        return rig_;
    }

private:
    static constexpr std::size_t kMostKeyBytes = 40;

    Status take(std::string_view key)
    {
        if (key == "image_width" || key == "image_Width")
            return once(rig_.width == 0, key, [&] { return whole(key, rig_.width); });
        if (key == "image_height" || key == "image_Height")
            return once(rig_.height == 0, key, [&] { return whole(key, rig_.height); });
        if (key == "imageSize" || key == "image_size")
            return once(rig_.width == 0 && rig_.height == 0, key,
                        [&] { return read_size(events_, key, rig_.width, rig_.height); });
        if (key == "K1" || key == "M1")
            return matrix(key, rig_.left.intrinsic, "3 x 3");
        if (key == "K2" || key == "M2")
            return matrix(key, rig_.right.intrinsic, "3 x 3");
        if (key == "D1")
            return distortion(key, rig_.left);
        if (key == "D2")
            return distortion(key, rig_.right);
        if (key == "R")
            return matrix(key, rig_.rotation, "3 x 3");
        if (key == "T")
            return once(!rig_.translation_mm, key, [&]() -> Status {
                rig_.translation_mm = TRY(read_vector(events_, key));
                return {};
            });
        if (key == "R1")
            return matrix(key, rig_.left.rectifying, "3 x 3");
        if (key == "R2")
            return matrix(key, rig_.right.rectifying, "3 x 3");
        if (key == "P1")
            return matrix(key, rig_.left.projection, "3 x 4");
        if (key == "P2")
            return matrix(key, rig_.right.projection, "3 x 4");
        if (key == "Q")
            return matrix(key, rig_.reprojection, "4 x 4");
        if (key == "near_mm")
            return number(key, rig_.near_mm);
        if (key == "far_mm")
            return number(key, rig_.far_mm);
        if (key == "unit")
            return unit(key);
        if (key == "id")
            return id(key);
        events_.skip_value();
        return events_.status();
    }

    template <typename Read>
    Status once(bool first, std::string_view key, Read read)
    {
        return first ? read() : wrong_value(events_, key, "there once only");
    }

    template <std::size_t Rows, std::size_t Columns>
    Status matrix(std::string_view key, std::optional<Matrix<Rows, Columns>>& into, const char* shape)
    {
        return once(!into, key, [&]() -> Status {
            const RawMatrix raw = TRY(read_matrix(events_, key));
            if (raw.rows != static_cast<int>(Rows) || raw.columns != static_cast<int>(Columns))
                return wrong_shape(events_, key, raw, shape);
            into.emplace();
            for (std::size_t i = 0; i < Rows * Columns; ++i)
                (*into)[i / Columns][i % Columns] = raw.at[i];
            return {};
        });
    }

    Status distortion(std::string_view key, RigCamera& camera)
    {
        return once(!camera.distortion, key, [&]() -> Status {
            camera.distortion = TRY(read_distortion(events_, key));
            return {};
        });
    }

    Status whole(std::string_view key, int& into)
    {
        into = TRY(read_whole(events_, key));
        return {};
    }

    Status number(std::string_view key, std::optional<double>& into)
    {
        return once(!into, key, [&]() -> Status {
            into = TRY(read_number(events_, key));
            return {};
        });
    }

    Status unit(std::string_view key)
    {
        if (events_.kind() != Kind::kScalar || (events_.scalar() != "mm" && events_.scalar() != "m"))
            return wrong_value(events_, key, "mm or m");
        in_metres_ = events_.scalar() == "m";
        events_.next();
        return {};
    }

    Status id(std::string_view key)
    {
        const std::string_view text = events_.scalar();
        bool fits = events_.kind() == Kind::kScalar && text.size() <= RigFile::kIdBytes && rig_.id[0] == '\0';
        for (const char c : text)
            fits = fits &&
                   ((c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                    std::strchr("-_.:+", c) != nullptr) &&
                   c != '\0';
        if (!fits)
            return wrong_value(events_, key, "one word of 64 letters, digits or -_.:+ at most");
        text.copy(rig_.id, RigFile::kIdBytes);
        events_.next();
        return {};
    }

    void to_mm()
    {
        if (rig_.translation_mm)
            for (double& length : *rig_.translation_mm)
                length *= kMmPerMetre;
        for (RigCamera* camera : {&rig_.left, &rig_.right})
            if (camera->projection)
                for (auto& row : *camera->projection)
                    row[3] *= kMmPerMetre;
        if (rig_.reprojection)
            for (double& per_length : (*rig_.reprojection)[3])
                per_length /= kMmPerMetre;
    }

    Status check() const
    {
        const char* path = shown_path(name_);
        if (rig_.width == 0 || rig_.height == 0)
            return failure(Fault::kBadData,
                           "%s: image_width or image_height is missing or 0: add the size that the cameras were "
                           "calibrated with",
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
        return {};
    }

    YamlEvents& events_;
    const char* name_;
    RigFile rig_;
    bool in_metres_ = false;
};

} // namespace

Result<RigFile> parse_rig(std::span<const std::byte> text, const char* name)
{
    if (text.size() > kMaxRigFileBytes)
        return failure(Fault::kBadData, "%s: a rig file has 1 MiB at most: give the file that the calibration wrote",
                       shown_path(name));
    YamlEvents events{text, name};
    return RigReader{events, name}.read();
}

Result<RigFile> read_rig_file(const char* path)
{
    InputFile file;
    TRY(file.open(path));
    if (file.size_bytes() > kMaxRigFileBytes)
        return failure(Fault::kBadData, "%s: a rig file has 1 MiB at most: give the file that the calibration wrote",
                       shown_path(path));
    try {
        std::vector<std::byte> text(static_cast<std::size_t>(file.size_bytes()));
        const std::size_t read = TRY(file.read(text));
        return parse_rig(std::span{text}.first(read), path);
    } catch (const std::bad_alloc&) {
        return failure(Fault::kOsError, "%s: no memory to read it", shown_path(path));
    }
}

} // namespace dicot
