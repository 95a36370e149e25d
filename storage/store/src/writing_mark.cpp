#include "writing_mark.h"

#include "card.h"
#include "folder_name.h"
#include "start_up.h"

#include <cerrno>

namespace dicot {

Errno WritingMark::try_to_put()
{
    Medium::File file = 0;
    const Errno made = medium_.create(kWriting, file);
    if (made.ok())
        (void)medium_.close(file);
    return made;
}

bool WritingMark::put()
{
    last_ = try_to_put();
    if (last_.number() == ENOSPC && release_ballast(medium_))
        last_ = try_to_put();
    const bool made = last_.ok();
    if (last_.number() == EEXIST)
        last_ = 0;
    return !made;
}

Status WritingMark::make_sure()
{
    if (!last_.ok())
        (void)put();
    return on_card(last_, kWriting, "making it");
}

void WritingMark::remove()
{
    (void)medium_.remove_file(kWriting);
}

} // namespace dicot
