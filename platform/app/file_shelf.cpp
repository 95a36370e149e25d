#include "file_shelf.h"

#include "dicot/os/output_file.h"

namespace dicot::app {

Status DiskShelf::put(const char* name, FunctionRef<Status(ByteSink&)> fill)
{
    OutputFile file;
    TRY(file.open(name));
    TRY(fill(file));
    return file.commit();
}

} // namespace dicot::app
