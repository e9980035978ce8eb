// SPDX-License-Identifier: MIT
#include "common/image/interruption.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <initializer_list>

namespace rasterbook {
namespace {

// Whoever changes one of the two then reads the other. So of a signal and a file's end or begin,
// at least one sees the other.
std::atomic<int> files_being_written = 0, ending_signal = 0;
static_assert(std::atomic<int>::is_always_lock_free, "a signal's handler may take no lock");

/// Ends the process as the signal does by default; from its handler, when that returns.
void end_by(int number) {
    signal(number, SIG_DFL);
    raise(number);
}

void end_when_files_are_whole(int number) {
    const int error = errno;
    ending_signal = number;
    if (files_being_written == 0) end_by(number);
    errno = error;
}

void leave() {
    if (--files_being_written == 0 && ending_signal != 0) end_by(ending_signal);
}

}  // namespace

void protect_files() {
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
        if (fcntl(stream, F_GETFD) < 0)  // open takes the lowest number that is free: this one
            open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    for (const int number : {SIGPIPE, SIGXFSZ}) signal(number, SIG_IGN);

    struct sigaction action{};
    action.sa_handler = end_when_files_are_whole;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction before{};
        sigaction(number, nullptr, &before);
        if (before.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);
    }
}

UninterruptedWrite::UninterruptedWrite() {
    ++files_being_written;
    if (ending_signal == 0) return;
    leave();
    for (;;) pause();  // the last one that is left ends the process
}

UninterruptedWrite::~UninterruptedWrite() { leave(); }

}  // namespace rasterbook
