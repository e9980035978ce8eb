// SPDX-License-Identifier: MIT
#include "support/lesson_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <mutex>

#include <gtest/gtest.h>

namespace rasterbook::test {

std::string read_text(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

StartedProgram::StartedProgram(const std::string& name, const std::vector<std::string>& arguments)
    : folder_(fresh_folder("process")) {
    const std::filesystem::path out = folder_ / "out", err = folder_ / "err";
    const char* const other_build = std::getenv("RASTERBOOK_OTHER_BUILD");
    const char* const emulator = std::getenv("RASTERBOOK_EMULATOR");
    std::vector<std::string> words;
    if (emulator) words.emplace_back(emulator);
    words.push_back(std::filesystem::path(other_build ? other_build : RASTERBOOK_LESSONS) / name);
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT,
                                     0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT,
                                     0600);
    posix_spawnattr_t attributes;  // as from a terminal, also where the tests run in the background
    posix_spawnattr_init(&attributes);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    const int failure =
        posix_spawnp(&process_, argv[0], &actions, &attributes, argv.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    EXPECT_EQ(failure, 0) << "cannot start " << words[0];
    if (failure != 0) process_ = -1;
}

StartedProgram::~StartedProgram() {
    send(SIGKILL);
    wait();
}

void StartedProgram::send(int signal) const {
    if (process_ > 0) kill(process_, signal);
}

bool StartedProgram::is_running() const {
    siginfo_t ended{};
    return process_ > 0 &&
           waitid(P_PID, static_cast<id_t>(process_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           ended.si_pid == 0;
}

ProcessResult StartedProgram::wait() {
    int status = -1;
    if (process_ > 0) waitpid(process_, &status, 0);
    process_ = -1;
    ProcessResult result{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder_ / "out"),
                         read_text(folder_ / "err"), WIFSIGNALED(status) ? WTERMSIG(status) : 0};
    std::filesystem::remove_all(folder_);
    return result;
}

ProcessResult run_program(std::string name, std::vector<std::string> arguments) {
    if (const auto lab = std::ranges::find(arguments, "lab"); lab != arguments.end()) {
        arguments.erase(lab);
        name = "lab_" + name;
    }
    return StartedProgram(name, arguments).wait();
}

std::string bytes_of_picture(const std::string& lesson, std::vector<std::string> arguments) {
    const std::filesystem::path file = fresh_folder("picture") / "a.png";
    arguments.insert(arguments.end(), {"--out", file.string()});
    const ProcessResult run = run_program(lesson, arguments);
    EXPECT_EQ(run.exit_status, 0) << lesson << ": " << run.err;
    return read_text(file);
}

void expect_error(const ProcessResult& result, int exit_status, const std::string& text) {
    EXPECT_EQ(result.exit_status, exit_status);
    EXPECT_EQ(result.err.rfind("error: ", 0), 0u) << result.err;
    EXPECT_NE(result.err.find(text), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(result.out, "");
}

Files files_in(const std::filesystem::path& folder) {
    Files files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.is_regular_file())
            files[entry.path().filename().string()] = read_text(entry.path());
    return files;
}

std::string differing(const Files& a, const Files& b) {
    std::string names;
    for (const auto& [name, bytes] : a)
        if (!b.contains(name) || b.at(name) != bytes) names += name + ' ';
    for (const auto& [name, bytes] : b)
        if (!a.contains(name)) names += name + ' ';
    return names;
}

std::filesystem::path fresh_folder(const std::string& name) {
    struct Folders {
        std::vector<std::filesystem::path> paths;
        ~Folders() {
            std::error_code ignored;
            for (const auto& path : paths) std::filesystem::remove_all(path, ignored);
        }
    };
    static Folders folders;
    static std::mutex mutex;
    const std::scoped_lock lock(mutex);
    const auto folder = std::filesystem::temp_directory_path() /
                        ("rasterbook_" + name + "_" + std::to_string(getpid()) + "_" +
                         std::to_string(folders.paths.size()));
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    folders.paths.push_back(folder);
    return folder;
}

}  // namespace rasterbook::test
