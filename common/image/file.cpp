// SPDX-License-Identifier: MIT
#include "common/image/file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <string>
#include <system_error>

#include "common/image/input_error.hpp"
#include "common/image/interruption.hpp"

namespace rasterbook {
namespace {

namespace fs = std::filesystem;

/// The system's own words for the operation that has just failed.
std::string system_reason() { return std::generic_category().message(errno); }

/// A new file beside the target, which no other thread or process has; whatever bears its name at
/// the end is removed. After a rename that is nothing.
class TemporaryFile {
  public:
    explicit TemporaryFile(const fs::path& target) {
        std::string name = (target.parent_path() / ".rasterbook_XXXXXX.part").string();
        const int descriptor = mkstemps(name.data(), 5);  // 5: the length of ".part"
        if (descriptor < 0) throw InputError(target, "cannot be written: " + system_reason());
        close(descriptor);
        path_ = name;
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        std::error_code ignored;
        fs::remove(path_, ignored);
    }

    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

/// What the process takes away from the permissions of new files. It is read by setting it, so one
/// thread at a time does so.
mode_t current_umask() {
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    const mode_t mask = umask(0);
    umask(mask);
    return mask;
}

/// The permissions that the file has, or that a new one gets.
fs::perms permissions_of(const fs::path& target) {
    std::error_code error;  // asked once: another program may remove the file at any time
    const fs::file_status status = fs::status(target, error);
    if (fs::is_regular_file(status)) return status.permissions();
    return fs::perms{0666u & ~current_umask()};
}

/// The file that a name stands for, once it is certain that a file may be put there.
fs::path writable_target(const fs::path& file) {
    std::error_code error;
    fs::path target = fs::exists(file, error) ? fs::canonical(file, error) : file;
    if (error == std::errc::no_such_file_or_directory) {  // another program has just removed it
        target = file;
        error.clear();
    }
    if (error) throw InputError(file, "cannot be written: " + error.message());
    if (!fs::exists(file, error) && fs::is_symlink(file, error))
        throw InputError(file, "cannot be written: a link that leads nowhere");
    const fs::file_status status = fs::status(target, error);
    if (fs::exists(status) && !fs::is_regular_file(status))
        throw InputError(file, "cannot be written: not a regular file");

    const fs::path folder = target.has_parent_path() ? target.parent_path() : ".";
    if (!fs::is_directory(folder, error))
        throw InputError(file, "cannot be written: there is no folder " + folder.string());
    return target;
}

}  // namespace

std::string ending_of(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    for (char& c : ending)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return ending;
}

void check_regular_file(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (status.type() == fs::file_type::not_found) throw InputError(file, "there is no such file");
    if (status.type() == fs::file_type::none)
        throw InputError(file, "cannot be read: " + error.message());
    if (!fs::is_regular_file(status)) throw InputError(file, "not a regular file");
}

std::vector<std::uint8_t> read_whole_file(const fs::path& file, std::uintmax_t max_bytes) {
    check_regular_file(file);
    std::error_code error;
    const std::uintmax_t size = fs::file_size(file, error);
    if (error) throw InputError(file, "cannot be read: " + error.message());
    if (size > max_bytes)
        throw InputError(file, "longer than " + std::to_string(max_bytes) + " bytes");

    std::ifstream stream(file, std::ios::binary);
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
    if (!stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size)))
        throw InputError(file, "cannot be read: " + system_reason());
    return bytes;
}

void write_whole_file(const fs::path& file, std::span<const std::uint8_t> bytes) {
    const fs::path target = writable_target(file);
    const UninterruptedWrite until_it_is_whole;  // or removed
    const TemporaryFile temporary(target);

    std::ofstream stream(temporary.path(), std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
    stream.close();  // Only now have all bytes reached the system: a full disk shows here.
    if (!stream) throw InputError(file, "cannot be written: " + system_reason());

    std::error_code error;
    fs::permissions(temporary.path(), permissions_of(target), error);
    if (!error) fs::rename(temporary.path(), target, error);
    if (error) throw InputError(file, "cannot be written: " + error.message());
}

}  // namespace rasterbook
