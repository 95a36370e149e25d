// A folder of a real file system, prepared by friends and by enemies.
#include "temp_folder.h"

#include "dicot/medium/disk_medium.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

using namespace dicot;
using dicot::test::bytes_of;
using dicot::test::TempFolder;

namespace {

std::unique_ptr<Medium> medium_of(const TempFolder& folder)
{
    auto medium = open_disk_medium(folder.path(""));
    EXPECT_TRUE(medium.ok()) << medium.status().message();
    return std::move(medium).value();
}

Errno write_file(Medium& medium, const char* path, const std::string& text)
{
    Medium::File file = -1;
    if (const Errno error = medium.create(path, file); !error.ok())
        return error;
    const Errno written = medium.write(file, std::as_bytes(std::span{text}));
    const Errno closed = medium.close(file);
    return written.ok() ? closed : written;
}

std::vector<std::string> names_in(Medium& medium, const char* path)
{
    std::vector<std::string> names;
    const Errno listed = medium.list(path, [&](const MediumEntry& entry) {
        names.emplace_back(entry.name);
        return true;
    });
    EXPECT_EQ(listed.number(), 0);
    std::sort(names.begin(), names.end());
    return names;
}

int open_number(Medium& medium, const char* path)
{
    Medium::File file = -1;
    std::uint64_t size = 0;
    return medium.open(path, file, size).number();
}

TEST(DiskMedium, keeps_what_is_written_and_reads_it_back_in_pieces)
{
    TempFolder folder;
    const auto medium = medium_of(folder);
    EXPECT_EQ(medium->make_folder("2026").number(), 0);
    EXPECT_EQ(medium->make_folder("2026/a").number(), 0);
    EXPECT_EQ(medium->make_folder("2026/a").number(), EEXIST);
    EXPECT_EQ(write_file(*medium, "2026/a/f", "hello, card").number(), 0);
    EXPECT_EQ(bytes_of(folder.path("2026/a/f")).size(), 11U);

    Medium::File file = -1;
    std::uint64_t size = 0;
    ASSERT_EQ(medium->open("2026/a/f", file, size).number(), 0);
    EXPECT_EQ(size, 11U);
    std::array<std::byte, 7> piece{};
    std::size_t got = 0;
    ASSERT_EQ(medium->read(file, piece, got).number(), 0);
    EXPECT_EQ(got, 7U);
    ASSERT_EQ(medium->read(file, piece, got).number(), 0);
    EXPECT_EQ(got, 4U);
    EXPECT_EQ(piece[3], std::byte{'d'});
    ASSERT_EQ(medium->read(file, piece, got).number(), 0);
    EXPECT_EQ(got, 0U);
    EXPECT_EQ(medium->close(file).number(), 0);
    EXPECT_EQ(medium->close(file).number(), EBADF);
}

TEST(DiskMedium, reads_at_any_offset_beside_reading_on)
{
    TempFolder folder;
    const auto medium = medium_of(folder);
    ASSERT_EQ(write_file(*medium, "f", "hello, card").number(), 0);
    Medium::File file = -1;
    std::uint64_t size = 0;
    ASSERT_EQ(medium->open("f", file, size).number(), 0);
    std::array<std::byte, 4> piece{};
    std::size_t got = 0;
    const auto text = [&] { return std::string(reinterpret_cast<const char*>(piece.data()), got); };
    ASSERT_EQ(medium->read(file, piece, got).number(), 0);
    ASSERT_EQ(medium->read_at(file, 7, piece, got).number(), 0);
    EXPECT_EQ(text(), "card");
    ASSERT_EQ(medium->read_at(file, 9, piece, got).number(), 0);
    EXPECT_EQ(text(), "rd");
    for (const std::uint64_t behind : {std::uint64_t{11}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
        ASSERT_EQ(medium->read_at(file, behind, piece, got).number(), 0);
        EXPECT_EQ(got, 0U);
    }
    ASSERT_EQ(medium->read(file, piece, got).number(), 0);
    EXPECT_EQ(text(), "o, c") << "reading on";
    EXPECT_EQ(medium->close(file).number(), 0);
    EXPECT_EQ(medium->read_at(file, 0, piece, got).number(), EBADF);
}

TEST(DiskMedium, stamps_a_folder_anew_when_names_come_and_go_and_never_another_one_the_same)
{
    TempFolder folder;
    const auto medium = medium_of(folder);
    ASSERT_EQ(medium->make_folder("a").number(), 0);
    ASSERT_EQ(medium->make_folder("b").number(), 0);
    FolderStamp first, second;
    ASSERT_EQ(medium->stamp("a", first).number(), 0);
    ASSERT_EQ(medium->stamp("b", second).number(), 0);
    EXPECT_NE(first.id, second.id);
    ASSERT_EQ(medium->stamp("a", second).number(), 0);
    EXPECT_EQ(first, second);
    ASSERT_EQ(medium->make_folder("a/x").number(), 0);
    ::usleep(50'000); // a tick of the kernel's clock
    ASSERT_EQ(medium->rename("a/x", "b/x").number(), 0);
    ASSERT_EQ(medium->stamp("a", second).number(), 0);
    EXPECT_NE(first, second);
    EXPECT_EQ(medium->stamp("", second).number(), 0);
    EXPECT_EQ(medium->stamp("c", second).number(), ENOENT);
    ASSERT_EQ(write_file(*medium, "f", "text").number(), 0);
    EXPECT_EQ(medium->stamp("f", second).number(), ENOTDIR);
    ASSERT_EQ(::symlink("a", folder.path("link").c_str()), 0);
    EXPECT_NE(medium->stamp("link", second).number(), 0);
}

TEST(DiskMedium, creates_and_renames_without_ever_replacing)
{
    TempFolder folder;
    const auto medium = medium_of(folder);
    ASSERT_EQ(write_file(*medium, "old", "old").number(), 0);
    ASSERT_EQ(write_file(*medium, "new", "new").number(), 0);
    EXPECT_EQ(write_file(*medium, "old", "again").number(), EEXIST);
    EXPECT_EQ(medium->rename("new", "old").number(), EEXIST);
    EXPECT_EQ(bytes_of(folder.path("old")), (test::Bytes{'o', 'l', 'd'}));
    ASSERT_EQ(medium->make_folder("day").number(), 0);
    ASSERT_EQ(medium->make_folder("part").number(), 0);
    EXPECT_EQ(medium->rename("part", "day").number(), EEXIST) << "an empty folder would give way to a plain rename";
    EXPECT_EQ(medium->rename("part", "day/1").number(), 0);
    EXPECT_EQ(medium->rename("part", "day/2").number(), ENOENT);
    EXPECT_EQ(medium->rename("day", "day/1/day").number(), EINVAL);
    EXPECT_EQ(names_in(*medium, ""), (std::vector<std::string>{"day", "new", "old"}));
    EXPECT_EQ(medium->sync_folder("day").number(), 0);
    EXPECT_EQ(medium->sync_folder("").number(), 0);
    EXPECT_EQ(medium->sync_all().number(), 0);
}

TEST(DiskMedium, removes_files_and_empty_folders_alone)
{
    TempFolder folder;
    const auto medium = medium_of(folder);
    ASSERT_EQ(medium->make_folder("day").number(), 0);
    ASSERT_EQ(write_file(*medium, "day/f", "x").number(), 0);
    EXPECT_EQ(medium->remove_folder("day").number(), ENOTEMPTY);
    EXPECT_EQ(medium->remove_folder("day/f").number(), ENOTDIR);
    EXPECT_EQ(medium->remove_file("day").number(), EISDIR);
    EXPECT_EQ(medium->remove_file("day/f").number(), 0);
    EXPECT_EQ(medium->remove_file("day/f").number(), ENOENT);
    EXPECT_EQ(medium->remove_folder("day").number(), 0);
    EXPECT_TRUE(names_in(*medium, "").empty());
}

TEST(DiskMedium, refuses_paths_that_are_none)
{
    TempFolder folder;
    folder.write("f", std::string{"x"});
    const auto medium = medium_of(folder);
    ASSERT_EQ(medium->make_folder("day").number(), 0);
    for (const char* path : {"..", ".", "/f", "f/", "day//f", "day/../f", "./f", "day/.", "../x"}) {
        EntryKind kind{};
        EXPECT_EQ(medium->kind_of(path, kind).number(), path[0] == 'f' ? ENOTDIR : EINVAL) << path;
        EXPECT_NE(open_number(*medium, path), 0) << path;
        EXPECT_NE(medium->remove_file(path).number(), 0) << path;
        EXPECT_NE(medium->make_folder(path).number(), 0) << path;
        EXPECT_NE(medium->rename("f", path).number(), 0) << path;
        EXPECT_NE(medium->list(path, [](const MediumEntry&) { return true; }).number(), 0) << path;
    }
    EXPECT_EQ(medium->make_folder("").number(), EINVAL);
    EXPECT_EQ(medium->make_folder(std::string(256, 'n').c_str()).number(), ENAMETOOLONG);
    EXPECT_EQ(medium->make_folder(std::string(255, 'n').c_str()).number(), 0);
    EXPECT_EQ(medium->make_folder("f/x").number(), ENOTDIR);
}

TEST(DiskMedium, follows_no_link_out_of_the_card)
{
    TempFolder outside;
    outside.write("secret", std::string{"secret"});
    TempFolder folder;
    std::filesystem::create_directory_symlink(outside.path(""), folder.path("away"));
    std::filesystem::create_symlink(outside.path("secret"), folder.path("file"));
    const auto medium = medium_of(folder);

    EntryKind kind{};
    EXPECT_EQ(medium->kind_of("away", kind).number(), 0);
    EXPECT_EQ(kind, EntryKind::kOther);
    EXPECT_EQ(medium->kind_of("away/secret", kind).number(), ENOTDIR);
    EXPECT_EQ(open_number(*medium, "away/secret"), ENOTDIR);
    EXPECT_EQ(open_number(*medium, "file"), EINVAL);
    EXPECT_EQ(write_file(*medium, "away/new", "x").number(), ENOTDIR);
    EXPECT_EQ(write_file(*medium, "file", "x").number(), EEXIST);
    EXPECT_EQ(medium->make_folder("away/new").number(), ENOTDIR);
    EXPECT_EQ(medium->remove_file("away/secret").number(), ENOTDIR);
    EXPECT_EQ(medium->rename("away/secret", "mine").number(), ENOTDIR);
    EXPECT_EQ(medium->list("away", [](const MediumEntry&) { return true; }).number(), ENOTDIR);
    EXPECT_EQ(medium->sync_folder("away").number(), ENOTDIR);
    EXPECT_EQ(medium->remove_file("file").number(), 0) << "the link itself";
    EXPECT_EQ(bytes_of(outside.path("secret")).size(), 6U);
    EXPECT_EQ(outside.files(), 1U);
}

TEST(DiskMedium, opens_no_pipe_and_says_what_stands_there)
{
    TempFolder folder;
    ASSERT_EQ(::mkfifo(folder.path("pipe").c_str(), 0600), 0);
    const auto medium = medium_of(folder);
    ASSERT_EQ(medium->make_folder("day").number(), 0);
    ASSERT_EQ(write_file(*medium, "f", "").number(), 0);
    EXPECT_EQ(open_number(*medium, "pipe"), EINVAL);
    EXPECT_EQ(open_number(*medium, "day"), EISDIR);
    EXPECT_EQ(open_number(*medium, "none"), ENOENT);
    std::vector<std::pair<std::string, EntryKind>> seen;
    EXPECT_EQ(medium
                  ->list("",
                         [&](const MediumEntry& entry) {
                             seen.emplace_back(entry.name, entry.kind);
                             return true;
                         })
                  .number(),
              0);
    std::sort(seen.begin(), seen.end());
    const std::vector<std::pair<std::string, EntryKind>> expected{
        {"day", EntryKind::kFolder}, {"f", EntryKind::kFile}, {"pipe", EntryKind::kOther}};
    EXPECT_EQ(seen, expected);
}

TEST(DiskMedium, lists_more_names_than_one_call_of_the_system_gives_and_stops_when_told)
{
    TempFolder folder;
    const auto medium = medium_of(folder);
    const std::string tail(200, 'n');
    for (int k = 100; k < 200; ++k)
        ASSERT_EQ(medium->make_folder((std::to_string(k) + tail).c_str()).number(), 0);
    const auto names = names_in(*medium, "");
    ASSERT_EQ(names.size(), 100U);
    EXPECT_EQ(names.front(), "100" + tail);
    int seen = 0;
    EXPECT_EQ(medium->list("", [&](const MediumEntry&) { return ++seen < 3; }).number(), 0);
    EXPECT_EQ(seen, 3);
}

TEST(DiskMedium, has_few_open_files_and_gives_back_every_descriptor)
{
    TempFolder folder;
    const auto medium = medium_of(folder);
    const auto descriptors = [] { return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {}); };
    const auto before = descriptors();
    ASSERT_EQ(medium->make_folder("day").number(), 0);
    ASSERT_EQ(write_file(*medium, "day/f", "x").number(), 0);
    ASSERT_EQ(names_in(*medium, "day").size(), 1U);
    EXPECT_EQ(medium->sync_folder("day").number(), 0);
    EXPECT_EQ(open_number(*medium, "day/g"), ENOENT);
    EXPECT_EQ(descriptors(), before);
    Medium::File file = -1;
    std::uint64_t size = 0;
    int opened = 0;
    while (opened < 100 && medium->open("day/f", file, size).ok())
        ++opened;
    EXPECT_EQ(opened, 8);
    EXPECT_EQ(medium->open("day/f", file, size).number(), EMFILE);
    EXPECT_EQ(descriptors(), before + 8);
    EXPECT_EQ(medium->close(3).number(), 0);
    EXPECT_EQ(medium->open("day/f", file, size).number(), 0);
    EXPECT_EQ(file, 3);
    EXPECT_EQ(medium->write(-1, {}).number(), 0);
    const std::array<std::byte, 1> byte{};
    EXPECT_EQ(medium->write(99, byte).number(), EBADF);
}

TEST(DiskMedium, lets_one_writer_in)
{
    TempFolder folder;
    auto first = medium_of(folder);
    const auto second = medium_of(folder);
    EXPECT_EQ(first->lock().number(), 0);
    EXPECT_EQ(first->lock().number(), 0);
    EXPECT_EQ(second->lock().number(), EWOULDBLOCK);
    first.reset();
    EXPECT_EQ(second->lock().number(), 0);
}

TEST(DiskMedium, says_how_much_room_there_is)
{
    TempFolder folder;
    const auto medium = medium_of(folder);
    MediumSpace space;
    ASSERT_EQ(medium->space(space).number(), 0);
    const auto expected = std::filesystem::space(folder.path(""));
    EXPECT_EQ(space.total_bytes, expected.capacity);
    // Others write meanwhile.
    EXPECT_NEAR(static_cast<double>(space.free_bytes), static_cast<double>(expected.available),
                static_cast<double>(expected.capacity) / 20);
}

TEST(DiskMedium, asks_for_a_folder_that_is_there)
{
    TempFolder folder;
    folder.write("f", std::string{"x"});
    for (const char* name : {"none", "f"}) {
        const auto medium = open_disk_medium(folder.path(name));
        ASSERT_FALSE(medium.ok());
        EXPECT_EQ(medium.status().fault(), Fault::kNoInput);
        EXPECT_NE(std::string{medium.status().message()}.find(name), std::string::npos);
    }
}

} // namespace
