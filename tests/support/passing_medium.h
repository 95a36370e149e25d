// A card in front of another one: for tests that change one of its answers.
#pragma once

#include "dicot/medium/medium.h"

namespace dicot::test {

/// Passes everything on.
class PassingMedium : public Medium
{
public:
    explicit PassingMedium(Medium& card) : card_(card) {}

    Errno make_folder(const char* path) override { return card_.make_folder(path); }
    Errno rename(const char* from, const char* to) override { return card_.rename(from, to); }
    Errno remove_file(const char* path) override { return card_.remove_file(path); }
    Errno remove_folder(const char* path) override { return card_.remove_folder(path); }
    Errno kind_of(const char* path, EntryKind& kind) override { return card_.kind_of(path, kind); }
    Errno list(const char* path, FunctionRef<bool(const MediumEntry&)> visit) override
    {
        return card_.list(path, visit);
    }
    Errno stamp(const char* path, FolderStamp& stamp) override { return card_.stamp(path, stamp); }
    Errno create(const char* path, File& file) override { return card_.create(path, file); }
    Errno append(const char* path, File& file, std::uint64_t& size_bytes) override
    {
        return card_.append(path, file, size_bytes);
    }
    Errno write(File file, std::span<const std::byte> bytes) override { return card_.write(file, bytes); }
    Errno open(const char* path, File& file, std::uint64_t& size_bytes) override
    {
        return card_.open(path, file, size_bytes);
    }
    Errno read(File file, std::span<std::byte> into, std::size_t& got) override { return card_.read(file, into, got); }
    Errno read_at(File file, std::uint64_t offset, std::span<std::byte> into, std::size_t& got) override
    {
        return card_.read_at(file, offset, into, got);
    }
    Errno close(File file) override { return card_.close(file); }
    Errno sync_all() override { return card_.sync_all(); }
    Errno sync_folder(const char* path) override { return card_.sync_folder(path); }
    Errno space(MediumSpace& space) override { return card_.space(space); }
    Errno lock() override { return card_.lock(); }
    void unlock() override { card_.unlock(); }

private:
    Medium& card_;
};

} // namespace dicot::test
