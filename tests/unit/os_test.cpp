#include "dicot/os/clock.h"
#include "dicot/os/cpu.h"
#include "dicot/os/input_file.h"
#include "dicot/os/memory_block.h"
#include "dicot/os/output_file.h"
#include "dicot/os/process_memory.h"
#include "dicot/os/shown_path.h"

#include "temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstring>
#include <thread>

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace dicot {
namespace {

using testing::HasSubstr;

test::Bytes pattern(std::size_t count)
{
    test::Bytes bytes(count);
    for (std::size_t i = 0; i < count; ++i)
        bytes[i] = static_cast<std::uint8_t>(i * 31 + i / 251);
    return bytes;
}

class OutputFileTest : public testing::Test
{
protected:
    test::TempFolder folder_;
    OutputFile file_;
};

TEST_F(OutputFileTest, CommittedFileHoldsEveryByteAndNothingElseIsLeft)
{
    const std::string path = folder_.path("map.pfm");
    const test::Bytes bytes = pattern(3 * OutputFile::kBufferBytes + 17);
    ASSERT_TRUE(file_.open(path.c_str()).ok());
    for (std::size_t start = 0; start < bytes.size(); start += 1000)
        ASSERT_TRUE(file_.write(bytes.data() + start, std::min<std::size_t>(1000, bytes.size() - start)).ok());
    EXPECT_FALSE(std::filesystem::exists(path)) << "there before commit()";
    ASSERT_TRUE(file_.commit().ok());
    EXPECT_EQ(test::bytes_of(path), bytes);
    EXPECT_EQ(folder_.files(), 1U);
}

TEST_F(OutputFileTest, SyncedFileIsStillOutOfSightAndMayGrow)
{
    const std::string path = folder_.path("left.yaml");
    const test::Bytes bytes = pattern(100);
    ASSERT_TRUE(file_.open(path.c_str()).ok());
    ASSERT_TRUE(file_.write(bytes.data(), 60).ok());
    ASSERT_TRUE(file_.sync().ok());
    EXPECT_FALSE(std::filesystem::exists(path));
    ASSERT_TRUE(file_.write(bytes.data() + 60, 40).ok());
    ASSERT_TRUE(file_.commit().ok());
    EXPECT_EQ(test::bytes_of(path), bytes);
    OutputFile full;
    ASSERT_TRUE(full.open("/dev/full").ok());
    ASSERT_TRUE(full.write(bytes.data(), bytes.size()).ok());
    EXPECT_EQ(full.sync().fault(), Fault::kIoError);
}

TEST_F(OutputFileTest, LetGoWithoutCommitLeavesTheFolderAsItWas)
{
    const std::string path = folder_.write("cloud.drc", std::string("yesterday's"));
    {
        OutputFile file;
        ASSERT_TRUE(file.open(path.c_str()).ok());
        const test::Bytes bytes = pattern(100'000);
        ASSERT_TRUE(file.write(bytes.data(), bytes.size()).ok());
        EXPECT_EQ(folder_.files(), 2U);
    }
    EXPECT_EQ(folder_.files(), 1U);
    EXPECT_EQ(test::bytes_of(path).size(), std::strlen("yesterday's"));
}

TEST_F(OutputFileTest, ReplacedFileKeepsItsPermissionsAndALinkStaysALink)
{
    const std::string real = folder_.write("real", std::string("old"));
    ASSERT_EQ(::chmod(real.c_str(), 0640), 0);
    const std::string link = folder_.path("link");
    ASSERT_EQ(::symlink("real", link.c_str()), 0);
    ASSERT_TRUE(file_.open(link.c_str()).ok());
    ASSERT_TRUE(file_.write("new", 3).ok());
    ASSERT_TRUE(file_.commit().ok());
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    EXPECT_EQ(test::bytes_of(real), (test::Bytes{'n', 'e', 'w'}));
    struct stat what
    {
    };
    ASSERT_EQ(::stat(real.c_str(), &what), 0);
    EXPECT_EQ(what.st_mode & 0777U, 0640U);
}

TEST_F(OutputFileTest, APartFileOfAProcessThatLostItsPowerIsReplaced)
{
    const std::string path = folder_.path("out");
    folder_.write("out." + std::to_string(::getpid()) + ".part", std::string("torn"));
    ASSERT_TRUE(file_.open(path.c_str()).ok());
    ASSERT_TRUE(file_.commit().ok());
    EXPECT_EQ(test::bytes_of(path).size(), 0U);
    EXPECT_EQ(folder_.files(), 1U);
}

TEST_F(OutputFileTest, AFullDeviceIsAnIoErrorThatSaysSo)
{
    ASSERT_TRUE(file_.open("/dev/full").ok());
    ASSERT_TRUE(file_.write("x", 1).ok());
    const Status status = file_.commit();
    EXPECT_EQ(status.fault(), Fault::kIoError);
    EXPECT_THAT(status.message(), HasSubstr("/dev/full: the disk is full"));
    EXPECT_FALSE(file_.commit().ok()) << "a failed file must not succeed later";
}

TEST_F(OutputFileTest, WritingThatFailsHalfWayLeavesNothing)
{
    const std::string path = folder_.write("out", std::string("old"));
    // In a process of its own: the limit on file sizes is a property of the process.
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{40'000, 40'000};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        int code = 1;
        {
            OutputFile file;
            const test::Bytes bytes = pattern(100'000);
            if (file.open(path.c_str()).ok())
                code = file.write(bytes.data(), bytes.size()).exit_code();
            if (file.commit().ok())
                code = 2;
        }
        ::_exit(code);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(WEXITSTATUS(status), static_cast<int>(Fault::kIoError));
    EXPECT_EQ(folder_.files(), 1U);
    EXPECT_EQ(test::bytes_of(path).size(), 3U);
}

TEST_F(OutputFileTest, WhatCannotBeCreatedIsRefusedWithAReason)
{
    const std::string plain = folder_.write("plain", std::string("x"));
    const struct
    {
        std::string path;
        const char* reason;
    } cases[] = {
        {folder_.path("missing/out"), "folder does not exist"},
        {plain + "/out", "is a file and no folder"},
        {folder_.path(""), "is a folder"},
        {folder_.path(std::string(300, 'n')), "name is too long"},
        {"", "empty name"},
    };
    for (const auto& one : cases) {
        OutputFile file;
        const Status status = file.open(one.path.c_str());
        EXPECT_EQ(status.fault(), Fault::kCannotCreate) << one.path;
        EXPECT_THAT(status.message(), HasSubstr(one.reason));
    }
    EXPECT_EQ(folder_.files(), 1U);
}

TEST_F(OutputFileTest, APipeIsWrittenDirectly)
{
    const std::string path = folder_.path("pipe");
    ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
    test::Bytes got;
    std::thread reader([&] { got = test::bytes_of(path); });
    const test::Bytes bytes = pattern(50'000);
    EXPECT_TRUE(file_.open(path.c_str()).ok());
    EXPECT_TRUE(file_.write(bytes.data(), bytes.size()).ok());
    EXPECT_TRUE(file_.commit().ok());
    reader.join();
    EXPECT_EQ(got, bytes);
    EXPECT_EQ(folder_.files(), 1U);
}

TEST_F(OutputFileTest, StandardOutputContinuesWhereItIs)
{
    const std::string path = folder_.path("captured");
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        if (std::freopen(path.c_str(), "w", stdout) == nullptr)
            ::_exit(1);
        std::fputs("before ", stdout);
        std::fflush(stdout);
        OutputFile file;
        const bool good = file.open("/dev/stdout").ok() && file.write("file", 4).ok() && file.commit().ok();
        ::_exit(good ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(WEXITSTATUS(status), 0);
    const test::Bytes bytes = test::bytes_of(path);
    EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "before file");
}

TEST(InputFile, GivesTheBytesInOrderAndThenNoMore)
{
    const test::TempFolder folder;
    const test::Bytes bytes = pattern(5000);
    const std::string path = folder.write("in", bytes);
    InputFile file;
    ASSERT_TRUE(file.open(path.c_str()).ok());
    EXPECT_EQ(file.size_bytes(), bytes.size());
    test::Bytes got(6000);
    const auto into = std::as_writable_bytes(std::span{got});
    EXPECT_EQ(file.read(into.first(1234)).value(), 1234U);
    EXPECT_EQ(file.read(into.subspan(1234)).value(), 5000U - 1234U);
    EXPECT_EQ(file.read(into).value(), 0U);
    got.resize(5000);
    EXPECT_EQ(got, bytes);
}

TEST(InputFile, RefusesWhatIsNoFile)
{
    const test::TempFolder folder;
    const std::string pipe = folder.path("pipe");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    for (const std::string& path : {folder.path("missing"), folder.path(""), pipe, std::string("/dev/null")}) {
        InputFile file;
        const Status status = file.open(path.c_str());
        EXPECT_EQ(status.fault(), Fault::kNoInput) << path;
        EXPECT_THAT(status.message(), HasSubstr(path));
    }
}

/// Runs `act` in a process without root's powers and gives the exit code that it returns.
template <typename Act>
int as_nobody(const Act& act)
{
    const pid_t child = ::fork();
    if (child == 0) {
        if (::geteuid() == 0 && ::seteuid(65534) != 0)
            ::_exit(1);
        ::_exit(act());
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WEXITSTATUS(status);
}

TEST(Permissions, AreRespectedAndToldInBothDirections)
{
    const test::TempFolder folder;
    const std::string secret = folder.write("secret", std::string("x"));
    const std::string out = folder.path("out");
    ASSERT_EQ(::chmod(secret.c_str(), 0), 0);
    ASSERT_EQ(::chmod(folder.path("").c_str(), 0555), 0);
    const auto told = [](const Status& status) {
        return std::strstr(status.message(), "no permission") != nullptr ? status.exit_code() : 2;
    };
    EXPECT_EQ(as_nobody([&] {
                  InputFile file;
                  return told(file.open(secret.c_str()));
              }),
              static_cast<int>(Fault::kNoInput));
    for (const std::string& target : {out, secret}) {
        EXPECT_EQ(as_nobody([&] {
                      OutputFile file;
                      return told(file.open(target.c_str()));
                  }),
                  static_cast<int>(Fault::kCannotCreate))
            << target;
    }
    ASSERT_EQ(::chmod(folder.path("").c_str(), 0755), 0);
    EXPECT_EQ(folder.files(), 1U);
}

TEST(ShownPath, LeavesRoomForTheSentence)
{
    EXPECT_STREQ(shown_path("left.png"), "left.png");
    const std::string longest = std::string(4000, 'a') + "/left.png";
    EXPECT_LE(std::strlen(shown_path(longest.c_str())), 200U);
    EXPECT_THAT(shown_path(longest.c_str()), testing::EndsWith("a/left.png"));
}

TEST(MemoryBlock, IsZeroedPageAlignedAndAsLargeAsAsked)
{
    Result<MemoryBlock> block = MemoryBlock::map(100'001);
    ASSERT_TRUE(block.ok());
    const std::span<std::byte> bytes = block.value().bytes();
    EXPECT_EQ(bytes.size(), 100'001U);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(bytes.data()) % static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE)),
              0U);
    for (std::byte& byte : bytes) {
        ASSERT_EQ(byte, std::byte{0});
        byte = std::byte{0xA5};
    }
    MemoryBlock taken = std::move(block).value();
    EXPECT_EQ(taken.bytes().data(), bytes.data());
    EXPECT_EQ(MemoryBlock::map(0).value().bytes().size(), 0U);
}

TEST(MemoryBlock, RefusalIsAnOsErrorWithTheAmount)
{
    const Result<MemoryBlock> block = MemoryBlock::map(SIZE_MAX / 2);
    ASSERT_FALSE(block.ok());
    EXPECT_EQ(block.status().fault(), Fault::kOsError);
    EXPECT_THAT(block.status().message(), HasSubstr(std::to_string(SIZE_MAX / 2 / (1024 * 1024) + 1) + " MiB"));
}

TEST(ProcessMemory, SeesABlockComeAndGoAndRemembersThePeak)
{
    constexpr std::uint64_t kBytes = 48 << 20;
    constexpr std::uint64_t kAbout = 8 << 20;
    const ProcessMemory before = process_memory().value();
    std::uint64_t with = 0;
    {
        const Result<MemoryBlock> block = MemoryBlock::map(kBytes, Pages::kResident);
        ASSERT_TRUE(block.ok());
        with = process_memory().value().resident_bytes;
    }
    const ProcessMemory after = process_memory().value();
    EXPECT_GT(with + kAbout, before.resident_bytes + kBytes);
    EXPECT_LT(after.resident_bytes, with - kBytes + kAbout);
    EXPECT_GE(after.peak_bytes + kAbout, with);
    rusage usage{};
    ASSERT_EQ(::getrusage(RUSAGE_SELF, &usage), 0);
    EXPECT_NEAR(static_cast<double>(after.peak_bytes), static_cast<double>(usage.ru_maxrss) * 1024.0, double{kAbout});
}

TEST(Clock, SleepTakesTimeButNoProcessorAndWorkTakesBoth)
{
    const std::int64_t start_us = monotonic_us();
    const std::int64_t start_cpu_us = process_cpu_us();
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    EXPECT_GE(monotonic_us() - start_us, 60'000);
    EXPECT_LT(process_cpu_us() - start_cpu_us, 30'000);
    const std::int64_t work_us = monotonic_us();
    volatile unsigned sum = 0;
    while (process_cpu_us() - start_cpu_us < 40'000)
        sum = sum + 1;
    EXPECT_GE(monotonic_us() - work_us, 9'000);
}

TEST(Cpu, AgreesWithWhatTheKernelLists)
{
    std::ifstream stream("/proc/cpuinfo");
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    ASSERT_FALSE(text.empty());
#if defined(__x86_64__)
    EXPECT_EQ(cpu_features().avx2, text.find(" avx2") != std::string::npos);
    EXPECT_FALSE(cpu_features().neon);
#elif defined(__aarch64__)
    EXPECT_TRUE(cpu_features().neon);
#endif
}

} // namespace
} // namespace dicot
