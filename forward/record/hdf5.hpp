#pragma once

#include <hdf5.h>

#include <string>

namespace kerf::hdf5 {

/// Anything HDF5 refuses; the writer of a file turns it into an InputError that names the file.
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

}  // namespace kerf::hdf5
