// dicot process: a pair in, a compressed cloud out.
#include "cloud_report.h"
#include "cloud_work.h"
#include "commands.h"
#include "distinct_files.h"
#include "sealed_heap.h"

#include "dicot/os/output_file.h"
#include "dicot/os/process_memory.h"
#include "dicot/picture/read_picture.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>
#include <string>

namespace dicot::app {
namespace {

struct ProcessWords
{
    std::string left, right, cloud, ply;
    PictureNames pictures;
    CloudWords work;
    bool json = false;
};

Status check_output(const std::string& path, const char* ending)
{
    if (path.empty())
        return {};
    if (!CLI::detail::to_lower(path).ends_with(ending))
        return failure(Fault::kUsage, "%s: the name must end in %s", path.c_str(), ending);
    OutputFile can_be_written;
    return can_be_written.open(path.c_str());
}

Status check_outputs(const ProcessWords& words)
{
    TRY(check_distinct({words.left, words.right, words.work.rig},
                       {words.cloud, words.ply, words.pictures.preview, words.pictures.disparity}));
    TRY(check_output(words.cloud, ".drc"));
    TRY(check_output(words.ply, ".ply"));
    TRY(check_output(words.pictures.preview, ".png"));
    return check_output(words.pictures.disparity, ".png");
}

/// Two picture files as a source.
class PairFiles final : public PairSource
{
public:
    explicit PairFiles(const ProcessWords& words) : words_(words) {}

    Result<PictureSize> size() const
    {
        const PictureSize left = TRY(picture_size(words_.left.c_str()));
        const PictureSize right = TRY(picture_size(words_.right.c_str()));
        if (left.width != right.width || left.height != right.height)
            return failure(Fault::kBadData, "%s is %d x %d px, and %s %d x %d: a pair has one size",
                           words_.right.c_str(), right.width, right.height, words_.left.c_str(), left.width,
                           left.height);
        return left;
    }

    Status fill(ImageView<Rgb8> left, ImageView<Rgb8> right, Arena) override
    {
        TRY(read_picture(words_.left.c_str(), left));
        return read_picture(words_.right.c_str(), right);
    }

private:
    const ProcessWords& words_;
};

Status run(const ProcessWords& words)
{
    TRY(check_outputs(words));
    PairFiles files(words);
    const PictureSize size = TRY(files.size());
    const CloudPlan plan = TRY(make_cloud_plan(words.work, size.width, size.height, words.left.c_str()));
    const std::unique_ptr<CloudWork> work = TRY(CloudWork::make(plan, 0));
    DiskShelf disk;
    {
        const SealedHeap sealed;
        TRY(work->see(files, words.pictures, disk, true));
        TRY(work->encode(plan.meta));
        if (!words.ply.empty())
            TRY(work->write_ply(words.ply));
        TRY(work->write_cloud(words.cloud.c_str(), disk));
        TRY(work->write_preview(words.pictures, disk));
    }
    const ProcessMemory memory = TRY(process_memory());
    if (words.json) {
        nlohmann::json report = cloud_report(*work, words.work.match.method, memory.peak_bytes);
        report["output"] = words.cloud;
        std::printf("%s\n", report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
    } else {
        print_cloud_report(*work, words.cloud, memory.peak_bytes);
    }
    return {};
}

} // namespace

void add_process(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("process", "Compressed 3D cloud of a stereo pair");
    auto words = std::make_shared<ProcessWords>();
    command
        ->add_option("LEFT", words->left,
                     "left picture: PNG, JPEG or PPM; rectified when the rig file has P1 and P2 only")
        ->required();
    command->add_option("RIGHT", words->right, "right picture")->required();
    command->add_option("--rig", words->work.rig, "rig file of the two cameras (YAML)")->required();
    command->add_option("-o,--output", words->cloud, "cloud, .drc")->required();
    command->add_option("--ply", words->ply, "the cloud as .ply too");
    command->add_option("--preview", words->pictures.preview, "picture of the cloud from two viewpoints, .png");
    command->add_option("--disparity", words->pictures.disparity, "picture of the disparities in colour, .png");
    command->add_option("--near-mm", words->work.near_mm,
                        "nearest distance of the working range (default: the rig file's)");
    command->add_option("--far-mm", words->work.far_mm,
                        "farthest distance of the working range (default: the rig file's)");
    words->work.match.add_to(*command);
    command->add_flag("--json", words->json, "report as JSON");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
