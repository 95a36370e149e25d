// The gadget's folder, in a folder that is none of the kernel's; and who serves.
#include "usb/end_server.h"
#include "usb/gadget_child.h"
#include "usb/gadget_user.h"
#include "usb/gadget_words.h"
#include "usb/server_page.h"

#include "dicot/gadget/usb_gadget.h"
#include "temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <csignal>

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

using namespace dicot;
using namespace dicot::app;
using dicot::test::TempFolder;
using testing::HasSubstr;
namespace fs = std::filesystem;

class UsbGadgetTest : public testing::Test
{
protected:
    GadgetPlaces places() const
    {
        const std::string top = folder_.path("top");
        return {top + "/config", top + "/udc", top + "/run"};
    }
    std::string said(const std::string& file) const
    {
        std::ifstream in(places().gadget() + "/" + file);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void controllers(std::initializer_list<const char*> names) const
    {
        for (const char* name : names)
            fs::create_directories(places().controllers + "/" + name);
    }

    TempFolder folder_;
};

TEST_F(UsbGadgetTest, IsMadeOfWhatTheKernelAsksFor)
{
    const UsbGadget gadget(places());
    const GadgetWords words{0x0010, "dicot bed-3", "S1"};
    for (int again = 0; again < 2; ++again) { // what a process left is taken over
        ASSERT_TRUE(gadget.make(words).ok());
        EXPECT_EQ(said("idVendor"), "0x1d6b");
        EXPECT_EQ(said("idProduct"), "0x0100");
        EXPECT_EQ(said("bcdDevice"), "0x0010");
        EXPECT_EQ(said("strings/0x409/manufacturer"), "dicot");
        EXPECT_EQ(said("strings/0x409/product"), "dicot bed-3");
        EXPECT_EQ(said("strings/0x409/serialnumber"), "S1");
        EXPECT_EQ(said("os_desc/use"), "1");
        EXPECT_EQ(said("os_desc/qw_sign"), "MSFT100");
        EXPECT_EQ(fs::read_symlink(places().gadget() + "/configs/c.1/ffs.dicot"),
                  places().gadget() + "/functions/ffs.dicot");
        EXPECT_EQ(fs::read_symlink(places().gadget() + "/os_desc/c.1"), places().gadget() + "/configs/c.1");
    }
}

TEST_F(UsbGadgetTest, BindsToTheControllerThatIsNamedAndUnbinds)
{
    UsbGadget gadget(places());
    ASSERT_TRUE(gadget.make({0x0010, "p", "s"}).ok());
    std::ofstream(places().gadget() + "/UDC") << "\n";
    EXPECT_EQ(gadget.bound_to(), "");
    ASSERT_TRUE(gadget.bind("fe980000.usb").ok());
    EXPECT_EQ(gadget.bound_to(), "fe980000.usb");
    ASSERT_TRUE(gadget.unbind().ok());
    EXPECT_EQ(gadget.bound_to(), "");
}

TEST_F(UsbGadgetTest, SaysWhatABoardWithoutAPortNeeds)
{
    const Result<std::string> none = UsbGadget(places()).controller("");
    EXPECT_EQ(none.status().fault(), Fault::kUnavailable);
    EXPECT_THAT(none.status().message(), HasSubstr("dtoverlay=dwc2"));
}

TEST_F(UsbGadgetTest, TakesTheFirstControllerOrTheOneThatIsAskedFor)
{
    controllers({"b.usb", "a.usb"});
    const UsbGadget gadget(places());
    EXPECT_EQ(gadget.controller("").value(), "a.usb");
    EXPECT_EQ(gadget.controller("b.usb").value(), "b.usb");
    const Result<std::string> other = gadget.controller("c.usb");
    EXPECT_EQ(other.status().fault(), Fault::kUnavailable);
    EXPECT_THAT(other.status().message(), HasSubstr("a.usb, b.usb"));
}

TEST(GadgetSerial, IsAlwaysTheSameAndDoesNotTellTheMachineId)
{
    const std::string id = "0123456789abcdef0123456789abcdef";
    // printf 'dicot usb serial 0123456789abcdef0123456789abcdef' | sha256sum
    EXPECT_EQ(serial_of(id), "97daa464d8183d1f");
    EXPECT_NE(serial_of("1123456789abcdef0123456789abcdef"), serial_of(id));
    EXPECT_EQ(serial_of(""), "");
}

TEST(GadgetSerial, IsTheConfiguredOneOrNeedsAMachineId)
{
    UsbConfig usb;
    EXPECT_EQ(serial_for(usb, "/nowhere/number", "/nowhere/machine-id").status().fault(), Fault::kConfig);
    usb.serial = "BED-3";
    EXPECT_EQ(serial_for(usb, "/nowhere/number", "/nowhere/machine-id").value(), "BED-3");
}

TEST(GadgetSerial, IsOfTheBoardBeforeItsCard)
{
    const TempFolder folder;
    const std::string number = folder.path("serial-number"), id = folder.path("machine-id");
    std::ofstream(id) << "0123456789abcdef0123456789abcdef\n";
    const UsbConfig usb;
    EXPECT_EQ(serial_for(usb, number.c_str(), id.c_str()).value(), "97daa464d8183d1f");
    std::ofstream(number) << std::string("10000000a1b2c3d4\0", 17);
    // printf 'dicot usb serial 10000000a1b2c3d4' | sha256sum
    EXPECT_EQ(serial_for(usb, number.c_str(), id.c_str()).value(), "6ea14c68fafa0d98");
    std::ofstream(number) << std::string("0000000000000000\0", 17);
    EXPECT_EQ(serial_for(usb, number.c_str(), id.c_str()).value(), "97daa464d8183d1f");
}

TEST(GadgetWords, HaveTheVersionInBinaryCodedDecimals)
{
    EXPECT_EQ(gadget_words("bed", "s", "0.1.0").version_bcd, 0x0010);
    EXPECT_EQ(gadget_words("bed", "s", "12.3.4").version_bcd, 0x1234);
    EXPECT_EQ(gadget_words("bed", "s", "1.0.0").product, "dicot bed");
}

TEST(ServerPage, IsHeldByOneProcessAndSeenByOthers)
{
    const TempFolder folder;
    const std::string path = folder.path("server");
    EXPECT_EQ(server_of(path), 0);
    EXPECT_FALSE(look_at_server(path).has_value());
    int ready[2], over[2];
    ASSERT_EQ(::pipe(ready), 0);
    ASSERT_EQ(::pipe(over), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        Result<ServerPage> page = ServerPage::take(path);
        if (!page.ok())
            ::_exit(1);
        page.value().figures().bytes_sent = 12345678901;
        page.value().figures().magic = ServerFigures::kMagic;
        (void)!::write(ready[1], "r", 1);
        char end = 0;
        ::close(over[1]);
        (void)!::read(over[0], &end, 1);
        ::_exit(0);
    }
    char byte = 0;
    ASSERT_EQ(::read(ready[0], &byte, 1), 1);
    EXPECT_EQ(server_of(path), child);
    const std::optional<SeenServer> seen = look_at_server(path);
    ASSERT_TRUE(seen.has_value());
    EXPECT_EQ(seen->process, child);
    EXPECT_EQ(seen->bytes_sent, 12345678901U);
    EXPECT_EQ(ServerPage::take(path).status().fault(), Fault::kTryAgain);
    ::close(over[0]);
    ::close(over[1]);
    int ended = 0;
    ASSERT_EQ(::waitpid(child, &ended, 0), child);
    EXPECT_EQ(ended, 0);
    EXPECT_EQ(server_of(path), 0); // however it ended
    EXPECT_TRUE(ServerPage::take(path).ok());
}

mode_t mode_of(const std::string& path)
{
    struct stat told
    {
    };
    return ::lstat(path.c_str(), &told) == 0 ? told.st_mode & 07777 : 0;
}

TEST(ServerPage, LetsEverybodyReadTheFiguresAndNobodyTakeTheLock)
{
    const TempFolder folder;
    const std::string path = folder.path("server");
    const mode_t before = ::umask(0027);
    const bool taken = ServerPage::take(path).ok();
    ::umask(before);
    ASSERT_TRUE(taken);
    EXPECT_EQ(mode_of(path), 0644U);
    EXPECT_EQ(mode_of(path + ".lock"), 0600U);
}

TEST_F(UsbGadgetTest, KeepsItsFolderToItselfAndFollowsNoLink)
{
    fs::create_directories(folder_.path("top"));
    const UsbGadget gadget(places());
    const mode_t before = ::umask(0077);
    EXPECT_TRUE(gadget.make_run_folder().ok());
    ::umask(before);
    EXPECT_EQ(mode_of(places().run), 0755U);
    ASSERT_EQ(::chmod(places().run.c_str(), 0777), 0);
    EXPECT_TRUE(gadget.make_run_folder().ok());
    EXPECT_EQ(mode_of(places().run), 0755U);
    fs::remove(places().run);
    fs::create_directory(folder_.path("elsewhere"));
    ASSERT_EQ(::chmod(folder_.path("elsewhere").c_str(), 0700), 0);
    fs::create_symlink(folder_.path("elsewhere"), places().run);
    EXPECT_FALSE(gadget.make_run_folder().ok());
    EXPECT_EQ(mode_of(folder_.path("elsewhere")), 0700U);
}

/// A process that holds the lock and then waits, as this program or as `sleep`.
pid_t lock_holder(const std::string& lock, int command, bool as_sleep)
{
    int ready[2];
    if (::pipe2(ready, O_CLOEXEC) != 0)
        return -1;
    const pid_t child = ::fork();
    if (child == 0) {
        struct flock whole
        {
        };
        whole.l_type = F_WRLCK;
        const int file = ::open(lock.c_str(), O_RDWR | O_CREAT, 0600);
        if (::fcntl(file, command, &whole) != 0)
            ::_exit(1);
        (void)!::write(ready[1], "r", 1);
        if (as_sleep)
            ::execl("/bin/sleep", "sleep", "60", nullptr);
        ::sleep(60);
        ::_exit(0);
    }
    ::close(ready[1]);
    char byte = 0;
    const bool held = ::read(ready[0], &byte, 1) == 1 && (!as_sleep || ::read(ready[0], &byte, 1) == 0);
    ::close(ready[0]);
    EXPECT_TRUE(held);
    return child;
}

/// The signal that ended it; 0: none has, until now.
int ended_by(pid_t child, int how)
{
    int ended = 0;
    return ::waitpid(child, &ended, how) == child && WIFSIGNALED(ended) ? WTERMSIG(ended) : 0;
}

TEST(EndServer, EndsThisProgramAlone)
{
    const TempFolder folder;
    const std::string path = folder.path("server");
    EXPECT_EQ(end_server(path).value(), 0);
    const pid_t ours = lock_holder(path + ".lock", F_SETLK, false);
    EXPECT_EQ(end_server(path).value(), ours);
    EXPECT_EQ(ended_by(ours, 0), SIGTERM);
    const pid_t other = lock_holder(path + ".lock", F_SETLK, true);
    const Result<pid_t> refused = end_server(path);
    EXPECT_EQ(refused.status().fault(), Fault::kUnavailable);
    EXPECT_THAT(refused.status().message(), HasSubstr("is left alone"));
    EXPECT_EQ(ended_by(other, WNOHANG), 0);
    (void)::kill(other, SIGKILL);
    EXPECT_EQ(ended_by(other, 0), SIGKILL);
}

TEST(EndServer, SignalsNobodyWhenTheLockDoesNotTellWhoHoldsIt)
{
    const TempFolder folder;
    const std::string path = folder.path("server");
    const pid_t holder = lock_holder(path + ".lock", F_OFD_SETLK, false);
    EXPECT_EQ(server_of(path), kSomebody);
    EXPECT_EQ(end_server(path).status().fault(), Fault::kUnavailable);
    EXPECT_EQ(ended_by(holder, WNOHANG), 0);
    (void)::kill(holder, SIGKILL);
    EXPECT_EQ(ended_by(holder, 0), SIGKILL);
}

TEST(GadgetChild, IsStartedWithoutTheServicesSocketAndEndsWithUs)
{
    const TempFolder folder;
    const std::string note = folder.path("note");
    ASSERT_EQ(::setenv("NOTIFY_SOCKET", "/run/nobody", 1), 0);
    {
        GadgetChild child;
        const std::string script = "trap 'echo ended >>" + note +
                                   "; exit 0' TERM; echo \"$DICOT_GADGET_PARENT ${NOTIFY_SOCKET-none}\" >" + note +
                                   ".part; mv " + note + ".part " + note + "; while :; do sleep 0.05; done";
        ASSERT_TRUE(child.start({"sh", "-c", script}, "/bin/sh").ok());
        for (int i = 0; i < 600 && !fs::exists(note); ++i)
            ::usleep(50'000);
    }
    ::unsetenv("NOTIFY_SOCKET");
    std::ifstream in(note);
    std::string first, second;
    std::getline(in, first);
    std::getline(in, second);
    EXPECT_EQ(first, std::to_string(::getpid()) + " none");
    EXPECT_EQ(second, "ended");
}

TEST(GadgetUser, IsWhoTheStoreBelongsTo)
{
    const TempFolder folder;
    EXPECT_EQ(user_for(folder.path("")).user, ::getuid());
}

} // namespace
