// The material table of a scene that is being made: ids in the order in which materials are added; entry 0 is empty.
#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <unordered_set>
#include <vector>

namespace voxrt::voxelize {

/// More materials than a memory word tells apart.
struct TooManyMaterials : std::length_error {
    using std::length_error::length_error;
};

struct TableMaterial {
    std::string name;
    std::array<uint8_t, 3> colour; // sRGB
    bool mirror = false;
    bool authored = true; // false: in place of one that the author did not give
};

class MaterialTable {
public:
    static constexpr size_t kLimit = 255; // a memory word holds 8 bits, and id 0 is empty space

    explicit MaterialTable(TableMaterial empty) { place(std::move(empty)); }

    /// Adds a material and returns its id. A number is appended to a name that another material has. Throws
    /// TooManyMaterials.
    uint8_t add(TableMaterial material) {
        if (entries_.size() > kLimit)
            throw TooManyMaterials("uses more than 255 materials; merge some in the asset");
        const std::string name = material.name;
        for (int number = 2; names_.contains(material.name); ++number)
            material.name = name + " (" + std::to_string(number) + ")";
        return place(std::move(material));
    }

    /// By id.
    const std::vector<TableMaterial>& entries() const { return entries_; }

private:
    uint8_t place(TableMaterial material) {
        names_.insert(material.name);
        entries_.push_back(std::move(material));
        return static_cast<uint8_t>(entries_.size() - 1);
    }

    std::vector<TableMaterial> entries_;
    std::unordered_set<std::string> names_;
};

} // namespace voxrt::voxelize
