#pragma once

#include <fcntl.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "models/base/error.hpp"

namespace kerf::hdf5 {

/// Anything HDF5 refuses; `write_file` turns it into an InputError that names the file.
struct Failure {
  std::string what;
};

/// One HDF5 identifier, closed when it goes out of scope.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close, const char* what) : id_(id), close_(close) {
    if (id_ < 0) throw Failure{what};
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { close_(id_); }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

inline void check(herr_t status, const char* what) {
  if (status < 0) throw Failure{what};
}

/// HDF5 prints its error stack by default; we report one line of our own instead.
class QuietErrors {
 public:
  QuietErrors() {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;
  ~QuietErrors() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

/// Text of any length in UTF-8; to be closed with H5Tclose.
inline hid_t string_type() {
  const hid_t type = H5Tcopy(H5T_C_S1);
  if (type < 0 || H5Tset_size(type, H5T_VARIABLE) < 0 || H5Tset_cset(type, H5T_CSET_UTF8) < 0)
    throw Failure{"string type"};
  return type;
}

inline void write_attribute(hid_t owner, const char* name, const std::string& text) {
  const Handle type(string_type(), H5Tclose, "string type");
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "attribute space");
  const Handle attribute(H5Acreate2(owner, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, "attribute");
  const char* content = text.c_str();
  check(H5Awrite(attribute, type, &content), "attribute");
}

inline std::string read_attribute(hid_t owner, const char* name) {
  const Handle attribute(H5Aopen(owner, name, H5P_DEFAULT), H5Aclose, name);
  const Handle type(string_type(), H5Tclose, "string type");
  char* content = nullptr;
  check(H5Aread(attribute, type, &content), name);
  const std::string text = content;
  H5free_memory(content);
  return text;
}

inline void write_numbers(hid_t owner, const std::string& name, std::span<const double> numbers) {
  const hsize_t extent = numbers.size();
  const Handle space(H5Screate_simple(1, &extent, nullptr), H5Sclose, "data space");
  const Handle set(H5Dcreate2(owner, name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                   H5Dclose, "dataset");
  if (!numbers.empty())
    check(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), "dataset");
}

inline std::vector<double> read_numbers(hid_t owner, const std::string& name) {
  const Handle set(H5Dopen2(owner, name.c_str(), H5P_DEFAULT), H5Dclose, name.c_str());
  const Handle space(H5Dget_space(set), H5Sclose, name.c_str());
  const hssize_t size = H5Sget_simple_extent_npoints(space);
  if (size < 0) throw Failure{name};
  std::vector<double> numbers(static_cast<std::size_t>(size));
  if (size > 0) check(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), name.c_str());
  return numbers;
}

/// The library is not built for threads; simulations that run side by side take turns.
inline std::mutex one_at_a_time;

/// Writes a new file beside `file` and lets it take that name once it is on the disk: a reader sees the old or the new
/// content, never a part. Creates missing parent folders. Throws InputError when the place cannot be written or HDF5
/// refuses something.
inline void write_file(const std::filesystem::path& file, const std::function<void(hid_t)>& write) {
  const std::lock_guard lock(one_at_a_time);

  const std::filesystem::path partial = std::filesystem::path(file) += fmt::format(".partial-{}", ::getpid());
  std::error_code ignored;
  try {
    const QuietErrors quiet;
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
    {
      const Handle h5(H5Fcreate(partial.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, "new file");
      write(h5);
      check(H5Fflush(h5, H5F_SCOPE_GLOBAL), "flush");
    }
    const int descriptor = ::open(partial.c_str(), O_RDONLY | O_CLOEXEC);
    const bool on_disk = descriptor >= 0 && ::fsync(descriptor) == 0;
    if (descriptor >= 0) ::close(descriptor);
    if (!on_disk) throw Failure{"fsync"};
    std::filesystem::rename(partial, file);
  } catch (const Failure& failure) {
    std::filesystem::remove(partial, ignored);
    throw InputError(fmt::format("{}: cannot be written (HDF5: {})", file.string(), failure.what));
  } catch (const std::filesystem::filesystem_error& failure) {
    std::filesystem::remove(partial, ignored);
    throw InputError(fmt::format("{}: cannot be written: {}", file.string(), failure.code().message()));
  }
}

}  // namespace kerf::hdf5
