#include "dicot/os/sha256.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace dicot {
namespace {

std::span<const std::byte> bytes_of(const std::string& text)
{
    return std::as_bytes(std::span{text.data(), text.size()});
}

std::string hex(const std::string& text)
{
    return hex_of(sha256_of(bytes_of(text))).data();
}

TEST(Sha256, GivesTheDigestsOfFips180)
{
    EXPECT_EQ(hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(hex(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, IsTheSameHoweverTheBytesAreCut)
{
    std::string text;
    for (int i = 0; i < 300; ++i)
        text += static_cast<char>(i * 7);
    const Sha256 whole = sha256_of(bytes_of(text));
    for (std::size_t part = 1; part <= text.size(); ++part) {
        Sha256Stream stream;
        for (std::size_t from = 0; from < text.size(); from += part)
            stream.update(bytes_of(text).subspan(from, std::min(part, text.size() - from)));
        ASSERT_EQ(stream.finish(), whole) << "parts of " << part;
    }
}

TEST(Sha256, AStreamBeginsAnewAfterItsDigest)
{
    Sha256Stream stream;
    stream.update(bytes_of("something else"));
    (void)stream.finish();
    stream.update(bytes_of("abc"));
    EXPECT_EQ(stream.finish(), sha256_of(bytes_of("abc")));
}

} // namespace
} // namespace dicot
