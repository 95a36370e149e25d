#include "pull_job.h"

#include "../stop_request.h"
#include "../store/shown.h"
#include "device_source.h"

namespace dicot::app {
namespace {

/// A phone or a camera beside the boards may refuse to talk; a board may not.
constexpr std::string_view kOurMaker = "dicot";

std::string name_of(const mtp::MtpListed& listed)
{
    const std::string_view product = listed.product.view();
    return "USB " + std::string{listed.port.view()} + (product.empty() ? "" : " (" + std::string{product} + ")");
}

} // namespace

Result<std::vector<PullJob>> jobs_of_devices(const std::string& serial)
{
    std::vector<PullJob> jobs;
    for (const mtp::MtpListed& listed : TRY(mtp::list_mtp_devices()))
        if (serial.empty() || listed.serial.view() == serial)
            jobs.push_back({name_of(listed), [listed] { return open_device(listed, StopRequest::asked); },
                            !serial.empty() || listed.manufacturer.view() == kOurMaker});
    if (!jobs.empty())
        return jobs;
    if (!serial.empty())
        return failure(Fault::kUnavailable,
                       "no device with serial number %s is plugged in: lsusb -v shows those there are",
                       shown(serial).c_str());
    return failure(Fault::kUnavailable, "no board is plugged in: is it a cable for data, in the port for devices, and "
                                        "usb.export on?");
}

} // namespace dicot::app
