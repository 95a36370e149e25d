#include "fault_trap.h"

#include <setjmp.h>

namespace dicot::proof {
namespace {

sigjmp_buf way_out;
volatile sig_atomic_t trapping = 0;

void leave(int signal)
{
    if (trapping != 0)
        siglongjmp(way_out, 1);
    ::signal(signal, SIG_DFL); // not the kernel's doing: the same access faults again, and the program ends
}

} // namespace

FaultTrap::FaultTrap()
{
    struct sigaction action = {};
    action.sa_handler = leave;
    sigemptyset(&action.sa_mask);
    sigaction(SIGSEGV, &action, &old_segv_);
    sigaction(SIGBUS, &action, &old_bus_);
}

FaultTrap::~FaultTrap()
{
    sigaction(SIGSEGV, &old_segv_, nullptr);
    sigaction(SIGBUS, &old_bus_, nullptr);
}

bool FaultTrap::holds(TaskRef step)
{
    if (sigsetjmp(way_out, 1) != 0) {
        trapping = 0;
        return false;
    }
    trapping = 1;
    step(0);
    trapping = 0;
    return true;
}

} // namespace dicot::proof
