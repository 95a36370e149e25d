// dicot rig convert: a rig in the words of other programs.
#include "distinct_files.h"
#include "rig_commands.h"
#include "rig_source.h"

#include "dicot/os/shown_path.h"
#include "dicot/rig/rig_id.h"
#include "dicot/rig/ros_files.h"

#include <charconv>
#include <cstdio>
#include <memory>
#include <string>

namespace dicot::app {
namespace {

struct RigConvertWords
{
    std::string rig, ros, opencv, size;
    double mm_per_unit = 0;
    bool unit_given = false;
};

/// "640x480"
Result<RigHints> hints_of(const RigConvertWords& words)
{
    RigHints hints;
    const char* const end = words.size.data() + words.size.size();
    const auto width = std::from_chars(words.size.data(), end, hints.width);
    const bool crossed = width.ptr != end && *width.ptr == 'x';
    const auto height = std::from_chars(crossed ? width.ptr + 1 : end, end, hints.height);
    const auto is_side = [](int side) { return side >= 1 && side <= kMaxRigPictureSide; };
    if (!words.size.empty() &&
        (height.ptr != end || height.ec != std::errc{} || !is_side(hints.width) || !is_side(hints.height)))
        return failure(Fault::kUsage, "--size %s: give width and height in px, as 640x480, %d at most",
                       shown_path(words.size.c_str()), kMaxRigPictureSide);
    constexpr double kLongestUnitMm = 1e6;
    if (words.unit_given && !(words.mm_per_unit > 0 && words.mm_per_unit <= kLongestUnitMm))
        return failure(Fault::kUsage,
                       "--unit-mm %g: say how many mm one unit of the file has: 1000 for metres, the side "
                       "of a square for squares",
                       words.mm_per_unit);
    hints.mm_per_unit = words.mm_per_unit;
    return hints;
}

Status convert(const RigConvertWords& words)
{
    if (words.ros.empty() && words.opencv.empty())
        return failure(Fault::kUsage, "rig convert: say what to write: --ros FOLDER or --opencv FILE");
    if (!words.ros.empty() && !is_folder(words.ros))
        return failure(Fault::kCannotCreate, "%s: no such folder: make it first", words.ros.c_str());
    const std::string at = words.ros.empty() ? std::string{} : words.ros + "/";
    const auto in_source = [&](const char* name) { return is_folder(words.rig) ? words.rig + "/" + name : words.rig; };
    TRY(check_distinct(
        {in_source("left.yaml"), in_source("right.yaml"), in_source("intrinsics.yml"), in_source("extrinsics.yml")},
        {at.empty() ? at : at + "left.yaml", at.empty() ? at : at + "right.yaml", words.opencv}));
    const RigHints hints = TRY(hints_of(words));
    RigFile rig = TRY(read_whole_rig(words.rig, hints));
    if (rig.id[0] == '\0')
        set_id(rig);
    if (!words.ros.empty()) {
        TRY(write_ros_files(rig, words.ros, words.rig.c_str()));
        std::printf("%s/left.yaml, %s/right.yaml\n", words.ros.c_str(), words.ros.c_str());
    }
    if (!words.opencv.empty()) {
        TRY(write_rig_file(words.opencv.c_str(), rig));
        std::printf("%s\n", words.opencv.c_str());
    }
    return {};
}

} // namespace

void add_rig_convert(CLI::App& rig, Command& chosen)
{
    auto words = std::make_shared<RigConvertWords>();
    CLI::App* command = rig.add_subcommand("convert", "Write it for ROS or OpenCV");
    command->add_option("RIG", words->rig, kRigSourceWords)->required();
    command->add_option("--ros", words->ros, "folder for left.yaml and right.yaml");
    command->add_option("--opencv", words->opencv, "rig file as OpenCV's FileStorage");
    command->add_option("--size", words->size, "of the pictures, where the source does not say it: 640x480");
    command
        ->add_option("--unit-mm", words->mm_per_unit,
                     "mm in one unit of length, where the source does not say it: 1000 for metres")
        ->each([words](const std::string&) { words->unit_given = true; });
    command->footer("A folder of OpenCV's stereo_calib says neither size nor unit:\n"
                    "  dicot rig convert FOLDER --size 640x480 --unit-mm 25 --opencv RIG.yaml");
    command->callback([words, &chosen] { chosen = [words] { return convert(*words); }; });
}

} // namespace dicot::app
