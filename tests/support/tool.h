// Programs of others that must be able to read what we write.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace dicot::test {

struct ToolRun
{
    int exit_code = -1;
    std::string output; ///< stdout and stderr
};

/// Runs a shell command to its end.
inline ToolRun run(const std::string& command)
{
    FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
    if (pipe == nullptr)
        throw std::runtime_error("cannot run " + command);
    ToolRun result;
    std::array<char, 4096> part{};
    while (const std::size_t size = std::fread(part.data(), 1, part.size(), pipe))
        result.output.append(part.data(), size);
    const int status = ::pclose(pipe);
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return result;
}

/// Whether a program is installed; a test that needs it fails with the name of its Debian package.
inline bool installed(const std::string& program)
{
    return run("command -v " + program).exit_code == 0;
}

} // namespace dicot::test

/// Fails the test when `program` of the Debian package `package` is not installed.
#define DICOT_NEED_TOOL(program, package)                                                                              \
    ASSERT_TRUE(::dicot::test::installed(program)) << program << " is not installed: apt-get install " << package
