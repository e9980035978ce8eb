// SPDX-License-Identifier: MIT
#include "support/lesson_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <mutex>

#include <gtest/gtest.h>

namespace rasterbook::test {

std::string read_text(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

ProcessResult run_program(const std::string& name, const std::vector<std::string>& arguments) {
    const std::filesystem::path folder = fresh_folder("process"), out = folder / "out",
                                err = folder / "err";
    std::vector<std::string> words{std::filesystem::path(RASTERBOOK_LESSONS) / name};
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
    pid_t child = -1;
    const int failure = posix_spawn(&child, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    EXPECT_EQ(failure, 0) << "cannot start " << words[0];
    int status = -1;
    if (failure == 0) waitpid(child, &status, 0);

    ProcessResult result{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(out),
                         read_text(err)};
    std::filesystem::remove_all(folder);
    return result;
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
