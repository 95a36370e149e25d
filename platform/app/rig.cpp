// dicot rig: what a rig file says, and the same in the words of other programs.
#include "commands.h"
#include "rectify_rig.h"

#include "dicot/rig/ros_files.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>
#include <string>
#include <sys/stat.h>
#include <vector>

namespace dicot::app {
namespace {

struct Words
{
    std::string rig, ros, opencv;
    bool json = false;
};

bool is_folder(const std::string& path)
{
    struct stat there
    {
    };
    return ::stat(path.c_str(), &there) == 0 && S_ISDIR(there.st_mode);
}

/// A rig file, or the folder of a camera_info pair.
Result<RigFile> read_any(const std::string& path)
{
    if (is_folder(path))
        return read_ros_files(path);
    return read_rig_file(path.c_str());
}

/// With R1 R2 P1 P2 Q, where the file has what they follow from and lacks one of them.
Result<RigFile> read_whole(const std::string& path)
{
    RigFile rig = TRY(read_any(path));
    const bool rectified = rig.left.rectifying && rig.right.rectifying && rig.left.projection && rig.right.projection;
    if (!rectified && describes_cameras(rig)) {
        const StereoRig stereo = TRY(stereo_rig_of(rig, path.c_str()));
        set_rectification(rig, TRY(rectify(stereo, kCrop, path.c_str())));
    }
    return rig;
}

/// `geometry` is null where the file does not tell how the cameras stand.
nlohmann::json as_json(const RigFile& rig, const RigGeometry* geometry)
{
    nlohmann::json report = {{"id", rig.id},
                             {"width", rig.width},
                             {"height", rig.height},
                             {"pictures", describes_cameras(rig) ? "as the cameras give them"
                                          : geometry != nullptr  ? "rectified"
                                                                 : "cameras not related"}};
    if (geometry != nullptr)
        report.update({{"rectified_focal_px", geometry->focal_px},
                       {"rectified_cx_px", geometry->cx_px},
                       {"rectified_cy_px", geometry->cy_px},
                       {"disparity_offset_px", geometry->disparity_offset_px},
                       {"baseline_mm", geometry->baseline_mm}});
    for (const auto& [key, camera] : {std::pair{"left", &rig.left}, std::pair{"right", &rig.right}}) {
        if (camera->intrinsic)
            report[key]["intrinsic_px"] = *camera->intrinsic;
        if (camera->distortion)
            report[key]["distortion"] = std::vector<double>(camera->distortion->at.begin(),
                                                            camera->distortion->at.begin() + camera->distortion->count);
    }
    if (rig.rotation)
        report["rotation"] = *rig.rotation;
    if (rig.translation_mm)
        report["translation_mm"] = *rig.translation_mm;
    if (rig.near_mm)
        report["near_mm"] = *rig.near_mm;
    if (rig.far_mm)
        report["far_mm"] = *rig.far_mm;
    return report;
}

Status show(const Words& words)
{
    const RigFile rig = TRY(read_whole(words.rig));
    const bool stands = rig.left.projection || rig.right.projection;
    const RigGeometry geometry = stands ? TRY(geometry_of(rig, words.rig.c_str())) : RigGeometry{};
    if (words.json) {
        std::printf("%s\n", as_json(rig, stands ? &geometry : nullptr).dump(2).c_str());
        return {};
    }
    std::printf("%s: id %s, pictures of %d x %d px, %s\n", words.rig.c_str(), rig.id[0] != '\0' ? rig.id : "(none)",
                rig.width, rig.height,
                describes_cameras(rig) ? "as the cameras give them"
                : stands               ? "rectified already"
                                       : "cameras not related to each other");
    for (const auto& [side, camera] : {std::pair{"left", &rig.left}, std::pair{"right", &rig.right}}) {
        if (!camera->intrinsic)
            continue;
        const Matrix<3, 3>& k = *camera->intrinsic;
        std::printf("%-5s fx %.3f  fy %.3f  cx %.3f  cy %.3f px; distortion", side, k[0][0], k[1][1], k[0][2], k[1][2]);
        for (int i = 0; camera->distortion && i < camera->distortion->count; ++i)
            std::printf(" %.6g", camera->distortion->at[static_cast<std::size_t>(i)]);
        std::printf("\n");
    }
    if (rig.translation_mm)
        std::printf("T %.4f %.4f %.4f mm\n", (*rig.translation_mm)[0], (*rig.translation_mm)[1],
                    (*rig.translation_mm)[2]);
    if (!stands)
        return {};
    std::printf("rectified: focal length %.3f px, principal point %.3f, %.3f px, baseline %.4f mm\n", geometry.focal_px,
                geometry.cx_px, geometry.cy_px, geometry.baseline_mm);
    return {};
}

Status convert(const Words& words)
{
    if (words.ros.empty() && words.opencv.empty())
        return failure(Fault::kUsage, "rig convert: say what to write: --ros FOLDER or --opencv FILE");
    if (!words.ros.empty() && !is_folder(words.ros))
        return failure(Fault::kCannotCreate, "%s: no such folder: make it first", words.ros.c_str());
    const RigFile rig = TRY(read_whole(words.rig));
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

void add_rig(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("rig", "What a rig file says, and the same for other programs");
    command->require_subcommand(1);
    auto words = std::make_shared<Words>();
    const char* source = "rig file, or folder of a ROS camera_info pair";
    CLI::App* shown = command->add_subcommand("show", "Print it");
    shown->add_option("RIG", words->rig, source)->required();
    shown->add_flag("--json", words->json, "report as JSON");
    shown->callback([words, &chosen] { chosen = [words] { return show(*words); }; });
    CLI::App* converted = command->add_subcommand("convert", "Write it for ROS or OpenCV");
    converted->add_option("RIG", words->rig, source)->required();
    converted->add_option("--ros", words->ros, "folder for left.yaml and right.yaml");
    converted->add_option("--opencv", words->opencv, "rig file as OpenCV's FileStorage");
    converted->callback([words, &chosen] { chosen = [words] { return convert(*words); }; });
}

} // namespace dicot::app
