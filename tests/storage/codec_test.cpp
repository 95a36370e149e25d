#include "cloud_cases.h"

#include "dicot/codec/decode_cloud.h"
#include "dicot/codec/encode_cloud.h"
#include "dicot/codec/stored_point.h"

#include <draco/attributes/attribute_quantization_transform.h>
#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#include <draco/metadata/geometry_metadata.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace dicot {
namespace {

using File = std::vector<std::byte>;

CloudGrid grid_of(int bits)
{
    return {100, bits, {-(1 << (bits - 1)), -(1 << (bits - 1)) + 17, 5000}};
}

CloudMeta full_meta()
{
    CloudMeta meta;
    meta.captured_at = "2024-05-18T12:00:00Z";
    meta.clock_trust = "ntp";
    meta.device_id = "greenhouse-1";
    meta.calibration_id = "c0ffee";
    meta.software = "dicot 0.1.0";
    meta.sequence = 4711;
    meta.skew_us = -350;
    meta.near_mm = 300.25;
    meta.far_mm = 1200;
    return meta;
}

File encoded(const std::vector<CloudPoint>& points, const CloudGrid& grid, const CloudMeta& meta = {},
             const std::vector<std::uint16_t>& leaf = {})
{
    File heap(encode_heap_bytes(points.size()) + leaf.size() * kLeafHeapBytes);
    const Result<EncodedCloud> result = encode_cloud({points, grid}, meta, heap, leaf);
    EXPECT_TRUE(result.ok()) << result.status().message();
    if (!result.ok())
        return {};
    const auto bytes = result.value().bytes;
    return {bytes.begin(), bytes.end()};
}

Result<std::vector<CloudPoint>> decoded(const File& file)
{
    const CloudOutline outline = TRY(outline_of(file, "cloud.drc"));
    static File heap;
    heap.resize(std::max(heap.size(), decode_heap_bytes(outline.points)));
    std::vector<CloudPoint> points(outline.points);
    TRY(decode_cloud(file, outline, "cloud.drc", heap, points));
    return points;
}

bool same(const CloudPoint& a, const CloudPoint& b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z && a.colour == b.colour && a.confidence == b.confidence;
}

/// Exactly in its place; each channel within 2 of 255 and the confidence within 8 of 255.
bool kept(const CloudPoint& read, const CloudPoint& given)
{
    const auto near = [](int a, int b, int most) { return std::abs(a - b) <= most; };
    return read.x == given.x && read.y == given.y && read.z == given.z && near(read.colour.r, given.colour.r, 2) &&
           near(read.colour.g, given.colour.g, 2) && near(read.colour.b, given.colour.b, 2) &&
           near(read.confidence, given.confidence, 8);
}

enum class Make
{
    kToday,  ///< rounded as FORMAT.md says
    kEarlier ///< exact colours, confidence on 8 bits
};

/// Draco's own encoder, asked for our layout. Its metadata is that of `described`, a file of ours.
File of_draco_itself(const std::vector<CloudPoint>& points, const CloudGrid& grid, const File& described, Make make)
{
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(described.data()), described.size());
    draco::Decoder decoder;
    const auto model = std::move(decoder.DecodePointCloudFromBuffer(&buffer)).value();
    draco::PointCloud cloud;
    cloud.set_num_points(static_cast<std::uint32_t>(points.size()));
    cloud.AddMetadata(std::make_unique<draco::GeometryMetadata>(*model->GetMetadata()));
    const auto add = [&](int like) -> draco::PointAttribute& {
        const draco::PointAttribute& shape = *model->attribute(like);
        draco::GeometryAttribute attribute;
        attribute.Init(shape.attribute_type(), nullptr, static_cast<std::uint8_t>(shape.num_components()),
                       shape.data_type(), shape.normalized(), shape.byte_stride(), 0);
        return *cloud.attribute(cloud.AddAttribute(attribute, true, cloud.num_points()));
    };
    draco::PointAttribute& position = add(0);
    draco::PointAttribute& colour = add(1);
    draco::PointAttribute& confidence = add(2);
    const auto metres = [&](std::int64_t steps) {
        return static_cast<float>(static_cast<double>(steps) * (grid.step_um * 1e-6));
    };
    for (std::uint32_t i = 0; i < cloud.num_points(); ++i) {
        const CloudPoint point = make == Make::kToday ? as_stored(points[i]) : points[i];
        const draco::AttributeValueIndex at(i);
        const float xyz[3] = {metres(point.x), metres(point.y), metres(point.z)};
        const float certainty = static_cast<float>(point.confidence) / 255.0F;
        position.SetAttributeValue(at, xyz);
        colour.SetAttributeValue(at, &point.colour);
        confidence.SetAttributeValue(at, &certainty);
    }
    draco::ExpertEncoder encoder(cloud);
    encoder.SetSpeedOptions(5, 5);
    encoder.SetEncodingMethod(draco::POINT_CLOUD_SEQUENTIAL_ENCODING);
    const float origin[3] = {metres(grid.origin[0]), metres(grid.origin[1]), metres(grid.origin[2])};
    const float zero = 0;
    encoder.SetAttributeExplicitQuantization(0, grid.bits, 3, origin, metres((std::int64_t{1} << grid.bits) - 1));
    encoder.SetAttributeExplicitQuantization(2, make == Make::kToday ? 4 : 8, 1, &zero, 1.0F);
    draco::EncoderBuffer out;
    EXPECT_TRUE(encoder.EncodeToBuffer(&out).ok());
    const auto bytes = std::as_bytes(std::span{out.data(), out.size()});
    return {bytes.begin(), bytes.end()};
}

TEST(Codec, EveryPointComesBackInItsPlace)
{
    for (const int bits : {14, 17, 20}) {
        const std::uint32_t seed = 7 + static_cast<std::uint32_t>(bits);
        const auto points = test::random_points(grid_of(bits), 20000, seed);
        const Result<std::vector<CloudPoint>> back = decoded(encoded(points, grid_of(bits)));
        ASSERT_TRUE(back.ok()) << back.status().message();
        ASSERT_EQ(back.value().size(), points.size());
        for (std::size_t i = 0; i < points.size(); ++i)
            ASSERT_TRUE(kept(back.value()[i], points[i])) << bits << " bits, seed " << seed << ", point " << i;
    }
}

TEST(Codec, EachColourAndConfidenceIsKeptWithinItsBoundAndBlackAndWhiteAreExact)
{
    std::vector<CloudPoint> points;
    for (int value = 0; value < 256; ++value) {
        const auto byte = static_cast<std::uint8_t>(value);
        points.push_back({0, 0, 6000, {byte, static_cast<std::uint8_t>(255 - value), byte}, byte});
    }
    const auto back = decoded(encoded(points, grid_of(14))).value();
    int worst_colour = 0;
    int worst_confidence = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        worst_colour = std::max(worst_colour, std::abs(back[i].colour.r - points[i].colour.r));
        worst_colour = std::max(worst_colour, std::abs(back[i].colour.g - points[i].colour.g));
        worst_confidence = std::max(worst_confidence, std::abs(back[i].confidence - points[i].confidence));
    }
    EXPECT_EQ(worst_colour, 2);
    EXPECT_EQ(worst_confidence, 8);
    for (const std::size_t end : {std::size_t{0}, std::size_t{255}})
        EXPECT_TRUE(same(back[end], points[end])) << end;
}

TEST(Codec, WhatWasStoredOnceChangesNoMore)
{
    const auto points = test::random_points(grid_of(14), 5000, 17);
    const File once = encoded(points, grid_of(14), full_meta());
    EXPECT_EQ(encoded(decoded(once).value(), grid_of(14), full_meta()), once);
}

TEST(Codec, TheBytesAreThoseOfDracosOwnEncoder)
{
    for (const int bits : {14, 20}) { // the entropy coder takes another way for large differences
        const auto points = test::random_points(grid_of(bits), 3000, 19);
        const File ours = encoded(points, grid_of(bits), full_meta());
        EXPECT_EQ(ours, of_draco_itself(points, grid_of(bits), ours, Make::kToday)) << bits;
    }
}

TEST(Codec, EarlierFilesWithExactColoursAndFineConfidencesAreReadAsTheyAre)
{
    const auto points = test::random_points(grid_of(14), 3000, 23);
    const File model = encoded(points, grid_of(14), full_meta());
    const auto back = decoded(of_draco_itself(points, grid_of(14), model, Make::kEarlier));
    ASSERT_TRUE(back.ok()) << back.status().message();
    for (std::size_t i = 0; i < points.size(); ++i)
        ASSERT_TRUE(same(back.value()[i], points[i])) << i;
}

TEST(Codec, TheCornersOfTheGridAreExact)
{
    const CloudGrid grid = grid_of(20);
    std::vector<CloudPoint> points;
    for (int corner = 0; corner < 8; ++corner) {
        const auto at = [&](int axis) { return grid.origin[axis] + ((corner >> axis & 1) != 0 ? (1 << 20) - 1 : 0); };
        points.push_back({at(0), at(1), at(2), {0, 128, 255}, static_cast<std::uint8_t>(corner == 0 ? 0 : 255)});
    }
    const auto back = decoded(encoded(points, grid));
    ASSERT_TRUE(back.ok()) << back.status().message();
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_TRUE(kept(back.value()[i], points[i])) << i;
}

TEST(Codec, OnePointIsACloud)
{
    const std::vector<CloudPoint> one{{0, 0, 6000, {1, 2, 3}, 4}};
    const auto back = decoded(encoded(one, grid_of(14)));
    ASSERT_TRUE(back.ok()) << back.status().message();
    EXPECT_TRUE(kept(back.value()[0], one[0]));
}

TEST(Codec, TheProofStatesBoundsAndTheRoundingOfFloat32)
{
    const std::vector<CloudPoint> points{{-10, 20, 6000, {}, 0}, {5, -7, 9000, {}, 255}, {0, 0, 7000, {}, 9}};
    File heap(encode_heap_bytes(points.size()));
    const CloudProof proof = encode_cloud({points, grid_of(14)}, {}, heap).value().proof;
    EXPECT_EQ(proof.points, 3U);
    EXPECT_EQ(proof.least[0], -10);
    EXPECT_EQ(proof.most[0], 5);
    EXPECT_EQ(proof.least[1], -7);
    EXPECT_EQ(proof.most[1], 20);
    EXPECT_EQ(proof.least[2], 6000);
    EXPECT_EQ(proof.most[2], 9000);
    EXPECT_LT(proof.worst_error_um, 0.3); // some 2^-24 of 1.6 m, twice
}

TEST(Codec, WhatIsKnownIsWrittenAndNothingElse)
{
    const std::vector<CloudPoint> points{{0, 0, 6000, {}, 0}};
    const CloudOutline full = outline_of(encoded(points, grid_of(15), full_meta()), "cloud.drc").value();
    EXPECT_EQ(full.meta, full_meta());
    EXPECT_EQ(full.points, 1U);
    EXPECT_EQ(full.grid.bits, 15);
    EXPECT_EQ(full.grid.step_um, 100);
    EXPECT_EQ(full.grid.origin[1], grid_of(15).origin[1]);
    const CloudOutline bare = outline_of(encoded(points, grid_of(14)), "cloud.drc").value();
    EXPECT_EQ(bare.meta, CloudMeta{});
}

TEST(Codec, SameCloudSameBytes)
{
    const auto points = test::random_points(grid_of(14), 5000, 3);
    EXPECT_EQ(encoded(points, grid_of(14), full_meta()), encoded(points, grid_of(14), full_meta()));
}

TEST(Codec, DracoSeesTheAttributesOfTheFormat)
{
    const CloudGrid grid = grid_of(14);
    const auto points = test::random_points(grid, 1000, 11);
    const File file = encoded(points, grid, full_meta());
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(file.data()), file.size());
    draco::Decoder decoder;
    decoder.SetSkipAttributeTransform(draco::GeometryAttribute::POSITION);
    const auto cloud = std::move(decoder.DecodePointCloudFromBuffer(&buffer)).value();
    ASSERT_EQ(cloud->num_attributes(), 3);
    ASSERT_EQ(cloud->num_points(), points.size());
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ(cloud->attribute(i)->size(), points.size());

    const draco::PointAttribute* position = cloud->GetNamedAttribute(draco::GeometryAttribute::POSITION);
    draco::AttributeQuantizationTransform quantisation;
    ASSERT_TRUE(quantisation.InitFromAttribute(*position));
    EXPECT_EQ(quantisation.quantization_bits(), 14);
    EXPECT_FLOAT_EQ(quantisation.range(), 16383 * 1e-4F);
    std::int32_t index[3];
    for (std::uint32_t i = 0; i < points.size(); ++i) { // the file holds grid indices, nothing rounded
        position->GetMappedValue(draco::PointIndex(i), index);
        ASSERT_EQ(index[0] + grid.origin[0], points[i].x);
        ASSERT_EQ(index[1] + grid.origin[1], points[i].y);
        ASSERT_EQ(index[2] + grid.origin[2], points[i].z);
    }
    EXPECT_TRUE(cloud->GetNamedAttribute(draco::GeometryAttribute::COLOR)->normalized());
    const auto* named = cloud->metadata()->GetAttributeMetadataByStringEntry("name", "confidence");
    ASSERT_NE(named, nullptr);
    EXPECT_EQ(cloud->attribute(cloud->GetAttributeIdByUniqueId(named->att_unique_id()))->attribute_type(),
              draco::GeometryAttribute::GENERIC);
    const auto text = [&](const char* key) {
        std::string value;
        cloud->metadata()->GetEntryString(key, &value);
        return value;
    };
    EXPECT_EQ(text("unit"), "m");
    EXPECT_EQ(text("frame"), "rectified-left x-right y-down z-forward");
    EXPECT_EQ(text("quantization_step"), "0.0001");
    EXPECT_EQ(text("captured_at"), "2024-05-18T12:00:00Z");
    EXPECT_EQ(text("sequence"), "4711");
    EXPECT_EQ(text("skew_us"), "-350");
}

/// Of one leaf, of none, and of the last one that has a number.
std::vector<std::uint16_t> leaves_of(std::size_t points)
{
    std::vector<std::uint16_t> leaf(points);
    for (std::size_t i = 0; i < points; ++i)
        leaf[i] = static_cast<std::uint16_t>(i % 7 == 0 ? 65535 : i % 3 == 0 ? 0 : 1 + i / 50);
    return leaf;
}

TEST(Codec, LeavesAreANamedAttributeThatDracoReadsAndTheRestIsAsWithoutThem)
{
    const CloudGrid grid = grid_of(14);
    const auto points = test::random_points(grid, 1000, 12);
    const auto leaf = leaves_of(points.size());
    const File file = encoded(points, grid, full_meta(), leaf);
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(file.data()), file.size());
    draco::Decoder decoder;
    const auto cloud = std::move(decoder.DecodePointCloudFromBuffer(&buffer)).value();
    ASSERT_EQ(cloud->num_attributes(), 4);
    const auto* named = cloud->metadata()->GetAttributeMetadataByStringEntry("name", "leaf");
    ASSERT_NE(named, nullptr);
    const auto* numbers = cloud->attribute(cloud->GetAttributeIdByUniqueId(named->att_unique_id()));
    EXPECT_EQ(numbers->data_type(), draco::DT_UINT16);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        std::uint16_t number = 0;
        numbers->GetMappedValue(draco::PointIndex(i), &number);
        ASSERT_EQ(number, leaf[i]) << i;
    }
    EXPECT_TRUE(outline_of(file, "cloud.drc").value().has_leaves);
    const File bare = encoded(points, grid, full_meta());
    EXPECT_FALSE(outline_of(bare, "cloud.drc").value().has_leaves);
    EXPECT_TRUE(std::ranges::equal(decoded(file).value(), decoded(bare).value(), same));
    EXPECT_TRUE(decoded(encoded(points, grid, {}, std::vector<std::uint16_t>(points.size()))).ok()) << "no leaf at all";
}

TEST(Codec, SenselessCloudsAreRefused)
{
    File heap(encode_heap_bytes(1));
    const std::vector<CloudPoint> none;
    const Result<EncodedCloud> empty = encode_cloud({none, grid_of(14)}, {}, heap);
    EXPECT_EQ(empty.status().fault(), Fault::kBadData);
    EXPECT_NE(std::strstr(empty.status().message(), "near_mm"), nullptr);
    const std::vector<CloudPoint> outside{{0, 0, 5000 + (1 << 14), {}, 0}};
    EXPECT_EQ(encode_cloud({outside, grid_of(14)}, {}, heap).status().fault(), Fault::kSoftware);
    const std::vector<CloudPoint> many(kMaxCloudPoints + 1);
    EXPECT_EQ(encode_cloud({many, grid_of(14)}, {}, heap).status().fault(), Fault::kConfig);
    const std::vector<std::uint16_t> two{1, 2};
    const std::vector<CloudPoint> one{{0, 0, 6000, {}, 0}};
    EXPECT_EQ(encode_cloud({one, grid_of(14)}, {}, heap, two).status().fault(), Fault::kSoftware);
}

TEST(HostileCloud, TruncatedFilesAreRefused)
{
    const auto points = test::random_points(grid_of(14), 300, 5);
    for (const File& whole : {encoded(points, grid_of(14), full_meta()),
                              encoded(points, grid_of(14), full_meta(), leaves_of(points.size()))})
        for (std::size_t size = 0; size < whole.size(); ++size) {
            const File part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
            EXPECT_EQ(decoded(part).status().fault(), Fault::kBadData) << size;
        }
}

TEST(HostileCloud, FlippedBitsAreRefusedOrGiveACloudOnTheGrid)
{
    const auto points = test::random_points(grid_of(14), 300, 6);
    const File without = encoded(points, grid_of(14), full_meta());
    const File with = encoded(points, grid_of(14), full_meta(), leaves_of(points.size()));
    std::mt19937 random{99};
    int refused = 0;
    for (int round = 0; round < 4000; ++round) {
        File file = round % 2 == 0 ? without : with;
        for (int flips = round % 3; flips >= 0; --flips)
            file[random() % file.size()] ^= static_cast<std::byte>(1U << random() % 8);
        const auto back = decoded(file);
        if (!back.ok()) {
            ++refused;
            continue;
        }
        const CloudGrid grid = outline_of(file, "cloud.drc").value().grid;
        for (const CloudPoint& point : back.value())
            ASSERT_TRUE(point.x >= grid.origin[0] && point.x - grid.origin[0] < 1 << grid.bits)
                << "round " << round << " of seed 99";
    }
    EXPECT_GT(refused, 500);
}

TEST(HostileCloud, AnAbsurdCountIsRefusedBeforeMemoryIsAsked)
{
    const std::vector<CloudPoint> points{{0, 0, 6000, {}, 0}};
    File file = encoded(points, grid_of(14));
    // The count stands in front of: one group of attributes, three of them, POSITION float32 x3.
    const std::byte mark[] = {std::byte{1}, std::byte{0}, std::byte{0}, std::byte{0},
                              std::byte{1}, std::byte{3}, std::byte{0}, std::byte{9}};
    const auto at = std::search(file.begin(), file.end(), std::begin(mark), std::end(mark));
    ASSERT_NE(at, file.end());
    at[3] = std::byte{0x7F};
    const Result<CloudOutline> outline = outline_of(file, "cloud.drc");
    EXPECT_EQ(outline.status().fault(), Fault::kBadData);
    EXPECT_NE(std::strstr(outline.status().message(), "number of points"), nullptr);
}

TEST(HostileCloud, OtherFilesAreNamedForWhatTheyAre)
{
    const std::string picture = "\x89PNG\r\n\x1a\n and so on";
    const auto bytes = std::as_bytes(std::span{picture.data(), picture.size()});
    EXPECT_NE(std::strstr(outline_of(bytes, "left.png").status().message(), "left.png: not a cloud file"), nullptr);
    EXPECT_NE(std::strstr(outline_of({}, "empty.drc").status().message(), "not a cloud file"), nullptr);

    draco::PointCloud foreign;
    foreign.set_num_points(2);
    draco::GeometryAttribute attribute;
    attribute.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
    const int id = foreign.AddAttribute(attribute, true, 2);
    const float at[6] = {0, 0, 0, 1, 1, 1};
    foreign.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(0), at);
    foreign.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(1), at + 3);
    draco::ExpertEncoder encoder(foreign);
    encoder.SetEncodingMethod(draco::POINT_CLOUD_KD_TREE_ENCODING);
    encoder.SetAttributeQuantization(id, 10);
    draco::EncoderBuffer out;
    ASSERT_TRUE(encoder.EncodeToBuffer(&out).ok());
    const Status status = outline_of(std::as_bytes(std::span{out.data(), out.size()}), "other.drc").status();
    EXPECT_NE(std::strstr(status.message(), "another program"), nullptr) << status.message();
}

} // namespace
} // namespace dicot
