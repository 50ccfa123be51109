#pragma once
/// What differs between POSIX and Windows: descriptors of files, temporary folders, locks of folders.

#include <cstddef>
#include <cstdint>
#include <string>

namespace lrb::platform {

/// Creates a file for writing, which child processes do not inherit. Returns its descriptor, or -1 and sets
/// errno if it cannot be created or exists.
int create_file(const std::string& path);
/// Opens an existing file, pipe or device for writing. Returns its descriptor, or -1 and sets errno.
int open_to_write(const std::string& path);
/// Writes at most `size` bytes. Returns the number written, or -1 and sets errno.
std::ptrdiff_t write(int file, const char* bytes, std::size_t size);
/// Returns 0, or -1 and sets errno.
int close(int file);
/// Removes a file. May be called from a signal handler.
void remove(const char* path);

/// Returns the number of this process, unique among running ones.
std::uint64_t process();

/// Returns true if a FIFO has a name. Anonymous pipes, as created by <(...) and |, are filled by the process
/// at the other end. Opening a named pipe blocks until a process writes to it.
bool has_name(const char* fifo);

/// Creates a folder with an unused name that begins with `start`, for this user. Returns its name, or nothing
/// and sets errno.
std::string create_folder(const std::string& start);

/// Returned by lock_folder().
inline constexpr int kNotLockable = -1, kOthersLock = -2;
/// Locks a folder against other processes. Returns a descriptor, with which the lock ends; it leaves no file
/// behind. Returns kOthersLock if another process has the lock, kNotLockable if there is no permission.
int lock_folder(const std::string& folder);

}  // namespace lrb::platform
