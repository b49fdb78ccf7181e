// Drives a verilated voxrt_rtu: clock, reset, load port, material table, frame, pixels.
#pragma once

#include "bit_fields.h"
#include "design.h"
#include "no_recorder.h"
#include "stall_pattern.h"

#include <voxrt/octree/words/words.h>

#include <verilated.h>
#include <verilated_syms.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace voxrt::rtl {

// A Recorder samples the model at both levels of each clock of a frame: no_recorder.h, wave_recorder.h.
template <class Model, class Recorder = NoRecorder<Model>> class VerilatedDesign final : public Design {
public:
    explicit VerilatedDesign(const Limits& limits) : limits_(limits) {
        context_.threads(VOXRT_RTL_THREADS);
        context_.traceEverOn(Recorder::traces);
        enter();
        model_ = std::make_unique<Model>(&context_, "TOP");
        model_->rst_ni = 0;
        model_->bus_rst_ni = 0;
        clock();
        model_->bus_rst_ni = 1;
    }

    ~VerilatedDesign() override {
        enter();
        recorder_.take();
        model_.reset();
        Verilated::threadContextp(Verilated::defaultContextp());
    }

    const Limits& limits() const override { return limits_; }

    void load(std::span<const uint32_t> words, bool lod_words, bool through_port) override {
        enter();
        lod_words_ = lod_words;
        put_lod(0);
        if (limits_.form == MemoryForm::cached)
            return dram_.map(words);
        if (through_port) {
            model_->access_i = 1;
            model_->access_write_i = 1;
            for (std::size_t address = 0; address < words.size(); ++address) {
                model_->access_address_i = static_cast<uint32_t>(address);
                model_->access_word_i = words[address];
                clock();
            }
            model_->access_i = 0;
            model_->access_write_i = 0;
            return;
        }
        const std::string memory = "TOP.voxrt_rtu.u_memory.gen_on_chip.u_memory";
        *variable(memory, "root_q") = memory_word(words[0]);
        if (limits_.form == MemoryForm::banked) {
            uint32_t* banks[16];
            for (unsigned bank = 0; bank < 16; ++bank)
                banks[bank] =
                    variable(memory + ".gen_banked.u_memory.gen_bank[" + std::to_string(bank) + "].u_ram", "data_q");
            const std::size_t top_rows = 8 * 256; // voxrt_banked_memory copies 256 blocks.
            const std::vector<uint32_t*> tops = copies(memory + ".gen_banked.u_memory.u_top");
            for (std::size_t row = 0; row + 1 < words.size(); ++row) {
                const std::size_t bank = (row ^ row >> 4) & 15;
                banks[bank][row >> 4] = memory_word(words[row + 1]);
                if (row < top_rows)
                    for (uint32_t* top : tops)
                        top[(row & ~std::size_t{15}) | bank] = memory_word(words[row + 1]);
            }
        } else {
            for (uint32_t* rows : copies(memory + ".gen_private.u_memory"))
                for (std::size_t row = 0; row + 1 < words.size(); ++row)
                    rows[row] = memory_word(words[row + 1]);
        }
    }

    std::vector<uint32_t> read_back(std::size_t count) override {
        enter();
        std::vector<uint32_t> words;
        model_->access_i = 1;
        for (std::size_t address = 0; words.size() < count; ++address) {
            model_->access_i = address < count;
            model_->access_address_i = static_cast<uint32_t>(address);
            clock();
            if (model_->access_valid_o)
                words.push_back(model_->access_word_o);
        }
        model_->access_i = 0;
        return words;
    }

    FrameCost render(const FrameRequest& request, const FrameImage& image, const std::function<void()>& poll) override {
        enter();
        reset();
        dram_.set_timing(request.dram);
        set_frame(request);
        recorder_.start(*model_);
        model_->start_i = 1;
        clock();
        model_->start_i = 0;

        const std::size_t pixels = std::size_t{request.width} * request.height;
        StallPattern stalls(request.stall_seed);
        std::size_t done = 0;
        for (uint64_t clocks = 1; done < pixels; ++clocks) {
            model_->pixel_ready_i = !stalls.next();
            if (model_->pixel_valid_o && model_->pixel_ready_i) {
                // voxrt_pkg::shaded_pixel_t.
                const uint64_t pixel = model_->pixel_o;
                image.colour[3 * done] = static_cast<uint8_t>(pixel >> 29);
                image.colour[3 * done + 1] = static_cast<uint8_t>(pixel >> 21);
                image.colour[3 * done + 2] = static_cast<uint8_t>(pixel >> 13);
                image.material[done] = static_cast<uint8_t>(pixel >> 5);
                image.face[done] = pixel >> 3 & 3;
                const bool last = done + 1 == pixels;
                const bool line_end = (done + 1) % request.width == 0;
                if ((pixel >> 2 & 1) != (done == 0) || (pixel >> 1 & 1) != line_end || (pixel & 1) != last)
                    throw std::logic_error("pixel " + std::to_string(done) + " has wrong first, line or last marks");
                ++done;
            }
            clock();
            if (clocks % poll_interval == 0) {
                if (image.done)
                    *image.done = done;
                poll();
            }
        }
        if (model_->busy_o)
            throw std::logic_error("busy after the last pixel");
        const unsigned errors = model_->error_o;
        // voxrt_pkg::counters_t, the last field lowest.
        return {.cycles = model_->counters_o[4],
                .words_read = model_->counters_o[2],
                .word_requests = model_->counters_o[7],
                .line_requests = model_->counters_o[6],
                .lines_read = model_->counters_o[5],
                .direction_overflow = (errors & 4) != 0,
                .bad_pointer = (errors & 2) != 0,
                .step_limit = (errors & 1) != 0,
                .bus_error = (errors & 8) != 0,
                .bus_timeout = (errors & 16) != 0};
    }

    std::string take_wave() override {
        enter();
        return recorder_.take();
    }

private:
    // Verilator's run time works on the calling thread's context, in destructors too: never on one that is gone.
    void enter() { Verilated::threadContextp(&context_); }

    static constexpr uint64_t poll_interval = 1 << 16;

    void clock() {
        const bool cached = limits_.form == MemoryForm::cached;
        if (cached)
            for (unsigned port = 0; port < Dram::ports; ++port)
                drive_bus(port);
        model_->clk_i = 0;
        model_->eval();
        recorder_.sample();
        if (cached) {
            for (unsigned port = 0; port < Dram::ports; ++port) {
                // voxrt_pkg::axi_read_request_t.
                const uint64_t request = model_->axi_o[port];
                dram_.accept(port, request >> 33 & 1, static_cast<uint32_t>(request >> 1), request & 1);
            }
            dram_.tick();
        }
        model_->clk_i = 1;
        model_->eval();
        recorder_.sample();
    }

    void drive_bus(unsigned port) {
        // voxrt_pkg::axi_read_response_t.
        const Dram::Response& response = dram_.drive(port);
        model_->axi_i[port][0] = static_cast<uint32_t>(response.rdata << 2) | response.rresp;
        model_->axi_i[port][1] = static_cast<uint32_t>(response.rdata >> 30);
        model_->axi_i[port][2] = static_cast<uint32_t>(response.rdata >> 62) | uint32_t{response.rvalid} << 2 |
                                 uint32_t{response.arready} << 3;
    }

    // The pixel buffers clear themselves after reset, a place a clock; no ray starts until they have.
    void reset() {
        model_->start_i = 0;
        model_->pixel_ready_i = 0;
        model_->rst_ni = 0;
        for (int i = 0; i < 16; ++i)
            clock();
        model_->rst_ni = 1;
        for (int i = 0; i < 256; ++i)
            clock();
    }

    void set_frame(const FrameRequest& request) {
        for (unsigned material = 0; material < 256; ++material) {
            // voxrt_pkg::material_write_t.
            const uint8_t* colour = request.materials + 3 * material;
            const uint32_t entry = uint32_t{request.mirrors[material] != 0} << 24 | uint32_t{colour[0]} << 16 |
                                   uint32_t{colour[1]} << 8 | colour[2];
            model_->material_write_i = uint64_t{1} << 33 | uint64_t{material} << 25 | entry;
            clock();
        }
        model_->material_write_i = 0;
        // voxrt_pkg::frame_t.
        auto frame = put_lod(request.lod_scale);
        for (const int32_t place : request.light_position)
            frame.put(static_cast<uint32_t>(place), 32);
        frame.put(request.bounces, 4);
        frame.put(request.ambient, 8);
        frame.put(request.light, 1);
        for (const int face : {0, 2, 4, 1, 3, 5}) // voxrt_pkg::faces_t: those that look along +axis are higher
            frame.put(request.brightness[face], 8);
        frame.put(request.faces, 1);
        frame.put(request.flat, 1);
        frame.put(request.root, 32);
        frame.put(request.depth, 5);
        frame.put(request.height, size_bits);
        frame.put(request.width, size_bits);
        for (const auto& direction : {request.up, request.right, request.look})
            for (int axis = 0; axis < 3; ++axis)
                frame.put(static_cast<uint16_t>(direction[axis]), 16);
        for (const int32_t place : request.position)
            frame.put(static_cast<uint32_t>(place), 32);
        frame.put(Dram::base, 32);
    }

    // The lowest fields of frame_t; the memory's port takes words of that dialect at any time.
    auto put_lod(uint32_t scale) {
        BitFields frame(model_->frame_i);
        frame.put(scale, 20);
        frame.put(lod_words_, 1);
        return frame;
    }

    // What voxrt_octree_memory keeps for a word.
    uint32_t memory_word(uint32_t word) const {
        const unsigned pointer_bits = limits_.block_bits > 9 ? limits_.block_bits : 9;
        const uint32_t leaf = 1u << (pointer_bits + (limits_.lod ? 8 : 0));
        if (lod_words_) {
            if (octree::is_tagged(word))
                return leaf | octree::material(word);
            const std::size_t block = octree::lod_block_number(word);
            return block >> limits_.block_bits
                       ? leaf | 0x100
                       : uint32_t{octree::lod_mean(word)} << pointer_bits | static_cast<uint32_t>(block);
        }
        if (octree::is_leaf(word))
            return leaf | octree::material(word);
        const std::size_t block = octree::block_number(word);
        return !octree::is_block_address(word) || block >> limits_.block_bits ? leaf | 0x100
                                                                              : static_cast<uint32_t>(block);
    }

    // The memories of a voxrt_private_memory.
    std::vector<uint32_t*> copies(const std::string& memory) const {
        std::vector<uint32_t*> found;
        for (unsigned copy = 0; copy < (limits_.lanes + 1) / 2; ++copy)
            found.push_back(variable(memory + ".gen_copy[" + std::to_string(copy) + "].u_ram", "data_q"));
        return found;
    }

    // A variable that the design marks public, wherever Verilator put it.
    uint32_t* variable(const std::string& scope_name, const char* name) const {
        const VerilatedScope* scope = context_.scopeFind(scope_name.c_str());
        VerilatedVar* found = scope ? scope->varFind(name) : nullptr;
        if (!found || found->vltype() != VLVT_UINT32)
            throw std::logic_error("the verilated design has no 32-bit variable " + scope_name + "." + name);
        return static_cast<uint32_t*>(found->datap());
    }

    Limits limits_;
    bool lod_words_ = false;
    VerilatedContext context_;
    std::unique_ptr<Model> model_;
    Recorder recorder_;
    Dram dram_;
};

} // namespace voxrt::rtl
