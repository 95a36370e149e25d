// Where a command's files go, each by its name.
#pragma once

#include "dicot/base/byte_sink.h"
#include "dicot/base/function_ref.h"

namespace dicot::app {

/// Nothing is taken from the heap.
class FileShelf
{
public:
    /// One file, whole or not at all. Errors: those of `fill`; Fault::kCannotCreate, kIoError.
    virtual Status put(const char* name, FunctionRef<Status(ByteSink&)> fill) = 0;

protected:
    ~FileShelf() = default;
};

/// Names are paths; each file is durable when put() returns.
class DiskShelf final : public FileShelf
{
public:
    Status put(const char* name, FunctionRef<Status(ByteSink&)> fill) override;
};

} // namespace dicot::app
