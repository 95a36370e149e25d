// How a session begins, breaks, begins again and ends.
#include "conversation.h"
#include "request.h"

#include "dicot/mtp/codes.h"

#include <algorithm>

#include <poll.h>

namespace dicot::mtp {
namespace {

constexpr int kReadyQuestions = 20;
constexpr int kFarewellMs = 2000; ///< for the end of a session that nobody needs any more

} // namespace

Status Initiator::open()
{
    failures_ = 0;
    if (const Status opened = open_session(); !opened.ok())
        TRY(recover(opened));
    return learn();
}

Status Initiator::open_session()
{
    talk_->be_patient(patience_.open_ms);
    const Status opened = say_open_session();
    talk_->be_patient(patience_.answer_ms);
    return opened;
}

Status Initiator::say_open_session()
{
    constexpr std::uint32_t kSession = 1;
    for (int round = 0; round < 2; ++round) {
        talk_->begin_session();
        Answer answer;
        TRY(say({operation::kOpenSession, {kSession}, 1, {}}, answer));
        if (answer.response_code == response::kOk) {
            ++sessions_;
            return {};
        }
        if (answer.response_code != response::kSessionAlreadyOpen)
            return refusal(answer.response_code, operation::kOpenSession);
        TRY(say({operation::kCloseSession, {}, 0, {}}, answer));
    }
    return failure(Fault::kIoError, "the device keeps a session that it does not close");
}

void Initiator::close() noexcept
{
    talk_->be_patient(std::min(patience_.open_ms, kFarewellMs));
    static_cast<void>(end_stream().ok());
    Answer answer;
    static_cast<void>(say({operation::kCloseSession, {}, 0, {}}, answer).ok());
}

/// Until a session is open again.
Status Initiator::recover(const Status& why)
{
    stream_ = {};
    for (Status last = why;;) {
        if (last.fault() == Fault::kUnavailable || last.fault() == Fault::kUsage || last.fault() == Fault::kOsError ||
            last.fault() == Fault::kSoftware)
            return last;
        if (++failures_ > kMostRecoveries)
            return failure(last.fault() == Fault::kTryAgain ? Fault::kUnavailable : Fault::kBadData,
                           "%s; it was reset %d times, plug it in again", last.message(), kMostRecoveries);
        // What the device thinks of these requests shows in the next answer; not every device knows them.
        static_cast<void>(pipe_.cancel(talk_->transaction()).ok());
        TRY(talk_->drain(patience_.drain_ms));
        pipe_.clear_halts();
        static_cast<void>(pipe_.reset().ok());
        TRY(await_ready());
        pipe_.clear_halts();
        TRY(talk_->drain(patience_.drain_ms));
        last = open_session();
        if (last.ok())
            return {};
    }
}

Status Initiator::await_ready()
{
    for (int question = 0; question < kReadyQuestions; ++question) {
        const Result<std::uint16_t> status = pipe_.status();
        if (!status.ok() && status.status().fault() == Fault::kUnavailable)
            return status.status();
        if (!status.ok() || status.value() == response::kOk)
            break;
        ::poll(nullptr, 0, patience_.pause_ms);
    }
    return {};
}

} // namespace dicot::mtp
