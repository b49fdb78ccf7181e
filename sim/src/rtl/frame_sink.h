// Catches one frame of an AXI4-Stream video as voxrt_pixel_packer sends it, and checks its marks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace voxrt::rtl {

class FrameSink {
public:
    void expect(unsigned width, unsigned height) {
        line_bytes_ = std::size_t{3} * width;
        frame_bytes_ = line_bytes_ * height;
        bytes_.clear();
        bytes_.reserve(frame_bytes_);
        lines_ = 0;
        fault_.clear();
        open_ = true;
    }

    // Whether a frame is expected and not yet complete.
    bool open() const { return open_; }
    bool complete() const { return !open_ && bytes_.size() == frame_bytes_ && fault_.empty(); }
    // What the stream did wrong; the frame ended there. Empty: nothing.
    const std::string& fault() const { return fault_; }
    // Row by row from the top, 3 bytes a pixel: green, blue, red.
    const std::vector<uint8_t>& bytes() const { return bytes_; }

    void accept(uint32_t data, unsigned keep, bool user, bool last) {
        if (user != bytes_.empty())
            return fail(user ? "tuser within a frame" : "a frame without tuser on its first word");
        if (keep != 0xF && !(last && (keep == 0x7 || keep == 0x3 || keep == 0x1)))
            return fail("a tkeep that is neither all bytes nor the first ones of a line's last word");
        for (; keep != 0; keep >>= 1, data >>= 8)
            bytes_.push_back(static_cast<uint8_t>(data));
        const std::size_t line_end = (lines_ + 1) * line_bytes_;
        if (last ? bytes_.size() != line_end : bytes_.size() >= line_end)
            return fail(last ? "tlast within a line" : "a line without tlast on its last word");
        lines_ += last;
        if (bytes_.size() == frame_bytes_)
            open_ = false;
    }

private:
    void fail(const char* what) {
        fault_ = std::string(what) + ", at byte " + std::to_string(bytes_.size());
        open_ = false;
    }

    std::size_t line_bytes_ = 0, frame_bytes_ = 0, lines_ = 0;
    std::vector<uint8_t> bytes_;
    std::string fault_;
    bool open_ = false;
};

} // namespace voxrt::rtl
