// dicot rectify: a pair as the cameras gave it in, the same pair with parallel rows out.
#include "commands.h"
#include "distinct_files.h"
#include "match_words.h"
#include "output_folder.h"
#include "rectify_rig.h"
#include "rig_source.h"
#include "stored_maps.h"
#include "take_picture.h"

#include "dicot/os/clock.h"
#include "dicot/picture/read_picture.h"
#include "dicot/picture/write_picture.h"
#include "dicot/rig/rig_id.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>

namespace dicot::app {
namespace {

constexpr int kLineStep = 32; // px between the lines of the proof

struct RectifyWords
{
    std::string left, right, rig, folder;
    std::string cpu = "auto";
    double keep = kCrop;
    bool proof = false;
};

Status check_size(const std::string& picture, const std::string& rig_path, const RigFile& rig)
{
    const PictureSize size = TRY(picture_size(picture.c_str()));
    if (size.width != rig.width || size.height != rig.height)
        return failure(Fault::kBadData,
                       "%s is %d x %d px, and %s is for %d x %d: use the rig file of these cameras and this size",
                       picture.c_str(), size.width, size.height, rig_path.c_str(), rig.width, rig.height);
    return {};
}

/// White where both pictures have a source.
void draw_mask(const RectifyTables& tables, ImageView<Rgb8> into, std::span<std::uint8_t> row)
{
    for (int y = 0; y < into.height; ++y) {
        std::fill_n(into.row(y), into.width, Rgb8{255, 255, 255});
        for (const RemapTable* table : {&tables.left(), &tables.right()}) {
            table->row_spans(y, tables.spans());
            table->row_mask(tables.spans(), row);
            for (int x = 0; x < into.width; ++x)
                if (row[static_cast<std::size_t>(x)] == 0)
                    into.at(x, y) = {0, 0, 0};
        }
    }
}

void draw_proof(ImageView<const Rgb8> left, ImageView<const Rgb8> right, ImageView<Rgb8> into)
{
    constexpr Rgb8 kLine{0, 255, 0};
    for (int y = 0; y < into.height; ++y) {
        std::copy_n(left.row(y), left.width, into.row(y));
        std::copy_n(right.row(y), right.width, into.row(y) + left.width);
        if (y % kLineStep == kLineStep / 2)
            std::fill_n(into.row(y), into.width, kLine);
    }
}

Status run(const RectifyWords& words)
{
    const Kernels* kernels = TRY(choose_kernels(words.cpu));
    const std::string at = words.folder + "/";
    TRY(check_distinct({words.left, words.right, words.rig, maps_path(words.rig)},
                       {at + "left.png", at + "right.png", at + "mask.png", at + "proof.png", at + "rig.yaml"}));
    RigFile rig = TRY(read_rig_for_use(words.rig));
    TRY(check_size(words.left, words.rig, rig));
    TRY(check_size(words.right, words.rig, rig));
    const RectifyTables tables = TRY(RectifyTables::load_or_build(rig, words.keep, words.rig.c_str()));
    const int width = rig.width;
    const int height = rig.height;
    const auto lay_out = [&](Arena& arena) {
        struct
        {
            ImageView<Rgb8> raw_left, raw_right, left, right, both;
            std::span<std::uint8_t> row;
        } pictures{
            take_picture<Rgb8>(arena, width, height),     take_picture<Rgb8>(arena, width, height),
            take_picture<Rgb8>(arena, width, height),     take_picture<Rgb8>(arena, width, height),
            take_picture<Rgb8>(arena, 2 * width, height), arena.take<std::uint8_t>(static_cast<std::size_t>(width))};
        return pictures;
    };
    Arena measure;
    (void)lay_out(measure);
    const MemoryBlock block = TRY(MemoryBlock::map(measure.peak()));
    Arena arena(block.bytes());
    const auto pictures = lay_out(arena);

    TRY(read_picture(words.left.c_str(), pictures.raw_left));
    TRY(read_picture(words.right.c_str(), pictures.raw_right));
    const std::int64_t start_us = monotonic_us();
    remap(tables.left(), *kernels, pictures.raw_left, pictures.left, tables.spans());
    remap(tables.right(), *kernels, pictures.raw_right, pictures.right, tables.spans());
    const double remap_ms = static_cast<double>(monotonic_us() - start_us) * 1e-3;

    TRY(make_folder(words.folder));
    TRY(write_png((at + "left.png").c_str(), pictures.left));
    TRY(write_png((at + "right.png").c_str(), pictures.right));
    draw_mask(tables, pictures.raw_left, pictures.row);
    TRY(write_png((at + "mask.png").c_str(), pictures.raw_left));
    if (words.proof) {
        draw_proof(pictures.left, pictures.right, pictures.both);
        TRY(write_png((at + "proof.png").c_str(), pictures.both));
    }
    TRY(write_rig_file((at + "rig.yaml").c_str(), [&] {
        RigFile flat = rig; // of rectified pictures: P1 and P2 only
        flat.left.intrinsic = flat.right.intrinsic = std::nullopt;
        flat.left.distortion = flat.right.distortion = std::nullopt;
        flat.left.rectifying = flat.right.rectifying = std::nullopt;
        flat.rotation = std::nullopt;
        flat.translation_mm = std::nullopt;
        set_id(flat);
        return flat;
    }()));

    std::printf("%s: focal length %.3f px, principal point %.3f, %.3f px, baseline %.3f mm\n", words.folder.c_str(),
                (*rig.left.projection)[0][0], (*rig.left.projection)[0][2], (*rig.left.projection)[1][2],
                -(*rig.right.projection)[0][3] / (*rig.right.projection)[0][0]);
    std::printf("tables: %s\n", tables.origin().c_str());
    print_table("left", tables.left());
    print_table("right", tables.right());
    std::printf("both pictures rectified in %.2f ms (%s)\n", remap_ms, kernels->name);
    return {};
}

} // namespace

void add_rectify(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("rectify", "A stereo pair with parallel rows");
    auto words = std::make_shared<RectifyWords>();
    command->add_option("LEFT", words->left, "left picture as the camera gave it: PNG, JPEG or PPM")->required();
    command->add_option("RIGHT", words->right, "right picture")->required();
    command->add_option("--rig", words->rig, "rig file of the two cameras (YAML)")->required();
    command->add_option("-o,--output", words->folder, "folder for left.png, right.png, mask.png and their rig.yaml")
        ->required();
    command->add_option("--keep", words->keep, "0 crops until no pixel lacks a source, 1 keeps every source pixel")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    command->add_option("--cpu", words->cpu, "auto, scalar, avx2 or neon")->capture_default_str();
    command->add_flag("--proof", words->proof, "proof.png too: both pictures side by side under horizontal lines");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
