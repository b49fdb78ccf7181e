// Records the signals of a design that was verilated with --trace-vcd, as the text of a VCD file.
#pragma once

#include <verilated_vcd_c.h>

#include <cstdint>
#include <string>
#include <utility>

namespace voxrt::rtl {

// Two samples per clock: one before its rising edge, one after it.
template <class Model> class WaveRecorder {
public:
    static constexpr bool traces = true;

    // Records from here to take(), for which the model must live.
    void start(Model& model) {
        vcd_.close();
        if (!attached_)
            model.trace(&vcd_, deepest);
        attached_ = true;
        text_.clear();
        time_ = 0;
        vcd_.open("wave");
    }
    void sample() {
        if (vcd_.isOpen())
            vcd_.dump(time_++);
    }
    std::string take() {
        vcd_.close();
        return std::exchange(text_, {});
    }

private:
    // Verilator writes into this in place of a file.
    class Text final : public VerilatedVcdFile {
    public:
        explicit Text(std::string& text) : text_(text) {}
        bool open(const std::string&) override { return true; }
        void close() override {}
        ssize_t write(const char* characters, ssize_t count) override {
            text_.append(characters, static_cast<std::size_t>(count));
            return count;
        }

    private:
        std::string& text_;
    };

    static constexpr int deepest = 99; // levels of the hierarchy

    std::string text_;
    Text file_{text_};
    VerilatedVcdC vcd_{&file_};
    uint64_t time_ = 0;
    bool attached_ = false;
};

} // namespace voxrt::rtl
