// SPDX-License-Identifier: MIT
/// @file
/// Signals and closed streams: they end a program, or a line of output, but spoil no file.
#pragma once

namespace rasterbook {

/// To be called first in main, once, by a program that writes files.
///
/// - SIGINT, SIGTERM and SIGHUP still end the program as if nothing handled them, at once or as
///   soon as no UninterruptedWrite is left. A signal that was ignored stays ignored, as by nohup.
/// - To write into a closed pipe, or beyond the limit of a file's size, fails as on a full disk;
///   no signal ends the program.
/// - Standard streams that are closed stay unusable, but no file that is opened later takes their
///   place: what the program says would be written into it.
void protect_files();

/// While one lives, a signal does not end the program. Once one has asked for the end, none begins:
/// its thread waits for the end instead.
class UninterruptedWrite {
  public:
    UninterruptedWrite();
    UninterruptedWrite(const UninterruptedWrite&) = delete;
    UninterruptedWrite& operator=(const UninterruptedWrite&) = delete;
    ~UninterruptedWrite();
};

}  // namespace rasterbook
