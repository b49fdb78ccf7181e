// Numbers of single or double precision, of which only some functions care which. Borrowed.
#pragma once

#include <cstddef>
#include <span>

namespace voxrt::voxelize {

class Numbers {
public:
    Numbers() = default;
    Numbers(std::span<const double> values) : doubles_(values.data()), size_(values.size()) {}
    Numbers(std::span<const float> values) : floats_(values.data()), size_(values.size()) {}

    double operator[](std::size_t at) const { return doubles_ != nullptr ? doubles_[at] : double{floats_[at]}; }
    std::size_t size() const { return size_; }

private:
    const double* doubles_ = nullptr;
    const float* floats_ = nullptr;
    std::size_t size_ = 0;
};

} // namespace voxrt::voxelize
