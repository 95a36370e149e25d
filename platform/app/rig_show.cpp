// dicot rig show: what a rig file says.
#include "rectify_rig.h"
#include "rig_commands.h"
#include "rig_source.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace dicot::app {
namespace {

struct RigShowWords
{
    std::string rig;
    bool json = false;
};

nlohmann::json as_json(const RigQuality& quality)
{
    nlohmann::json json = {{"verdict", quality.verdict},
                           {"pairs", quality.pairs},
                           {"rms_px", quality.rms_px},
                           {"epipolar_rms_px", quality.epipolar_rms_px},
                           {"epipolar_p95_px", quality.epipolar_p95_px},
                           {"held_out_mm", quality.held_out_mm},
                           {"held_out_depth_mm", quality.held_out_depth_mm},
                           {"nearest_mm", quality.nearest_mm},
                           {"farthest_mm", quality.farthest_mm}};
    for (std::size_t k = 0; k < RigQuality::kDepthsMm.size(); ++k)
        json["depth_error"].push_back(
            {{"distance_mm", RigQuality::kDepthsMm[k]}, {"calibration_mm", quality.depth_error_mm[k]}});
    return json;
}

void print(const RigQuality& quality)
{
    std::printf(
        "verdict: %s; %d pairs from %.0f to %.0f mm, RMS %.3f px; rows miss each other by %.3f px RMS, 95 %% by "
        "less than %.3f px\n",
        quality.verdict, quality.pairs, quality.nearest_mm, quality.farthest_mm, quality.rms_px,
        quality.epipolar_rms_px, quality.epipolar_p95_px);
    std::printf("held-out boards: shape off by %.2f mm, distance by %.2f mm; depth error to expect:",
                quality.held_out_mm, quality.held_out_depth_mm);
    for (std::size_t k = 0; k < RigQuality::kDepthsMm.size(); ++k)
        std::printf("%s +- %.2f mm at %d mm", k == 0 ? "" : ",", quality.depth_error_mm[k], RigQuality::kDepthsMm[k]);
    std::printf("\n");
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
    if (rig.calibrated_at[0] != '\0')
        report["calibrated_at"] = rig.calibrated_at;
    if (rig.quality)
        report["quality"] = as_json(*rig.quality);
    return report;
}

Status show(const RigShowWords& words)
{
    RigFile rig = TRY(read_whole_rig(words.rig));
    if (describes_cameras(rig)) { // what dicot makes of them, whatever R1 R2 P1 P2 in the file are
        const StereoRig stereo = TRY(stereo_rig_of(rig, words.rig.c_str()));
        set_rectification(rig, TRY(rectify(stereo, kCrop, words.rig.c_str())));
    }
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
    if (rig.calibrated_at[0] != '\0')
        std::printf("calibrated at %s\n", rig.calibrated_at);
    if (rig.quality)
        print(*rig.quality);
    if (rig.near_mm && rig.far_mm)
        std::printf("working range %.0f to %.0f mm\n", *rig.near_mm, *rig.far_mm);
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

} // namespace

void add_rig_show(CLI::App& rig, Command& chosen)
{
    auto words = std::make_shared<RigShowWords>();
    CLI::App* command = rig.add_subcommand("show", "Print it");
    command->add_option("RIG", words->rig, kRigSourceWords)->required();
    command->add_flag("--json", words->json, "report as JSON");
    command->callback([words, &chosen] { chosen = [words] { return show(*words); }; });
}

} // namespace dicot::app
