// dicot rig convert: a rig in the words of other programs.
#include "rig_commands.h"
#include "rig_source.h"

#include "dicot/rig/ros_files.h"

#include <cstdio>
#include <memory>
#include <string>

namespace dicot::app {
namespace {

struct Words
{
    std::string rig, ros, opencv;
};

Status convert(const Words& words)
{
    if (words.ros.empty() && words.opencv.empty())
        return failure(Fault::kUsage, "rig convert: say what to write: --ros FOLDER or --opencv FILE");
    if (!words.ros.empty() && !is_folder(words.ros))
        return failure(Fault::kCannotCreate, "%s: no such folder: make it first", words.ros.c_str());
    const RigFile rig = TRY(read_whole_rig(words.rig));
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
    auto words = std::make_shared<Words>();
    CLI::App* command = rig.add_subcommand("convert", "Write it for ROS or OpenCV");
    command->add_option("RIG", words->rig, kRigSourceWords)->required();
    command->add_option("--ros", words->ros, "folder for left.yaml and right.yaml");
    command->add_option("--opencv", words->opencv, "rig file as OpenCV's FileStorage");
    command->callback([words, &chosen] { chosen = [words] { return convert(*words); }; });
}

} // namespace dicot::app
