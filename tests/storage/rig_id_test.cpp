// Digests by Python's hashlib over bytes packed by struct, as storage/FORMAT.md describes them.
#include "dicot/rig/rig_id.h"

#include <gtest/gtest.h>

#include <cstring>

namespace dicot {
namespace {

RigFile camera_rig()
{
    RigFile rig;
    rig.width = 640;
    rig.height = 480;
    rig.left.intrinsic = {{{500, 0, 320}, {0, 501, 240}, {0, 0, 1}}};
    rig.left.distortion = Distortion{4, {-0.1, 0.02}};
    rig.right.intrinsic = {{{502, 0, 321}, {0, 503, 241}, {0, 0, 1}}};
    rig.rotation = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    rig.translation_mm = {-60, 0.5, 0.25};
    return rig;
}

TEST(RigId, IsTheDigestOfTheGeometry)
{
    EXPECT_STREQ(rig_id_of(camera_rig()).data(), "rig-fbd04f18ab6e1173");
    RigFile flat;
    flat.width = 640;
    flat.height = 480;
    flat.left.projection = {{{500, 0, 320, 0}, {0, 500, 240, 0}, {0, 0, 1, 0}}};
    flat.right.projection = {{{500, 0, 330, -30000}, {0, 500, 240, 0}, {0, 0, 1, 0}}};
    EXPECT_STREQ(rig_id_of(flat).data(), "rig-97d63e075f8d0c58");
}

TEST(RigId, EveryNumberOfTheGeometryCounts)
{
    const RigId id = rig_id_of(camera_rig());
    RigFile rig = camera_rig();
    rig.height = 479;
    EXPECT_NE(rig_id_of(rig), id);
    rig = camera_rig();
    (*rig.right.intrinsic)[2][2] += 1e-15;
    EXPECT_NE(rig_id_of(rig), id);
    rig = camera_rig();
    rig.right.distortion = Distortion{14, {}};
    EXPECT_EQ(rig_id_of(rig), id) << "no distortion and zeros are the same lens";
    rig.right.distortion->at[13] = 1e-9;
    EXPECT_NE(rig_id_of(rig), id);
    rig = camera_rig();
    (*rig.rotation)[0][1] = -0.0;
    EXPECT_EQ(rig_id_of(rig), id) << "0 has no sign";
    (*rig.rotation)[0][1] = 1e-300;
    EXPECT_NE(rig_id_of(rig), id);
    rig = camera_rig();
    (*rig.translation_mm)[2] = 0.2500001;
    EXPECT_NE(rig_id_of(rig), id);
    rig.translation_mm.reset();
    EXPECT_NE(rig_id_of(rig), id);
}

TEST(RigId, WhatIsNoGeometryDoesNotCount)
{
    RigFile rig = camera_rig();
    std::strcpy(rig.calibrated_at, "2026-03-01T12:00:00Z");
    rig.quality = RigQuality{};
    rig.near_mm = 1;
    rig.left.projection.emplace()[0][0] = 400;
    rig.left.rectifying.emplace()[0][0] = 1;
    EXPECT_EQ(rig_id_of(rig), rig_id_of(camera_rig()));
}

TEST(RigId, AHandThatChangedNumbersIsSeen)
{
    RigFile rig = camera_rig();
    EXPECT_TRUE(id_matches(rig)) << "no id, no promise";
    set_id(rig);
    EXPECT_STREQ(rig.id, rig_id_of(rig).data());
    EXPECT_TRUE(id_matches(rig));
    (*rig.left.intrinsic)[0][0] = 499;
    EXPECT_FALSE(id_matches(rig));
    std::strcpy(rig.id, "rig-of-the-greenhouse");
    EXPECT_TRUE(id_matches(rig)) << "a name of somebody's own";
}

} // namespace
} // namespace dicot
