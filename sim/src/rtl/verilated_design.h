// Drives a verilated voxrt_rtu: clock, reset, load port, material table, frame, pixels.
#pragma once

#include "design.h"
#include "stall_pattern.h"

#include <verilated.h>
#include <verilated_syms.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace voxrt::rtl {

template <class Model> class VerilatedDesign final : public Design {
public:
    explicit VerilatedDesign(const Limits& limits) : limits_(limits) {
        context_.threads(VOXRT_RTL_THREADS);
        enter();
        model_ = std::make_unique<Model>(&context_, "TOP");
        model_->rst_ni = 0;
        model_->eval();
    }

    ~VerilatedDesign() override {
        enter();
        model_.reset();
        Verilated::threadContextp(Verilated::defaultContextp());
    }

    const Limits& limits() const override { return limits_; }

    void load(std::span<const uint32_t> words, bool through_port) override {
        enter();
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
        const std::string memory = "TOP.voxrt_rtu.u_memory";
        *variable(memory, "root_q") = memory_word(words[0]);
        if (limits_.banked) {
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
        set_frame(request);
        model_->start_i = 1;
        clock();
        model_->start_i = 0;

        const std::size_t pixels = std::size_t{request.width} * request.height;
        StallPattern stalls(request.stall_seed);
        std::size_t done = 0;
        for (uint64_t clocks = 1; done < pixels; ++clocks) {
            model_->out_ready_i = !stalls.next();
            if (model_->out_valid_o && model_->out_ready_i) {
                const uint32_t colour = model_->out_colour_o;
                image.colour[3 * done] = static_cast<uint8_t>(colour >> 16);
                image.colour[3 * done + 1] = static_cast<uint8_t>(colour >> 8);
                image.colour[3 * done + 2] = static_cast<uint8_t>(colour);
                image.material[done] = static_cast<uint8_t>(model_->out_pixel_o >> 2);
                image.face[done] = model_->out_pixel_o & 3;
                const bool last = done + 1 == pixels;
                const bool line_end = (done + 1) % request.width == 0;
                if (model_->out_first_o != (done == 0) || model_->out_line_end_o != line_end ||
                    model_->out_last_o != last)
                    throw std::logic_error("pixel " + std::to_string(done) + " has wrong first, line or last marks");
                ++done;
            }
            clock();
            if (clocks % poll_interval == 0)
                poll();
        }
        if (model_->busy_o)
            throw std::logic_error("busy after the last pixel");
        const unsigned errors = model_->error_o;
        return {.cycles = model_->cycles_o,
                .words_read = model_->words_read_o,
                .direction_overflow = (errors & 4) != 0,
                .bad_pointer = (errors & 2) != 0,
                .step_limit = (errors & 1) != 0};
    }

private:
    // Verilator's run time works on the calling thread's context, in destructors too: never on one that is gone.
    void enter() { Verilated::threadContextp(&context_); }

    static constexpr uint64_t poll_interval = 1 << 16;

    void clock() {
        model_->clk_i = 0;
        model_->eval();
        model_->clk_i = 1;
        model_->eval();
    }

    // The pixel buffers clear themselves after reset, a place a clock; no ray starts until they have.
    void reset() {
        model_->start_i = 0;
        model_->out_ready_i = 0;
        model_->rst_ni = 0;
        for (int i = 0; i < 16; ++i)
            clock();
        model_->rst_ni = 1;
        for (int i = 0; i < 256; ++i)
            clock();
    }

    void set_frame(const FrameRequest& request) {
        model_->table_write_i = 1;
        for (unsigned material = 0; material < 256; ++material) {
            const uint8_t* colour = request.materials + 3 * material;
            model_->table_material_i = static_cast<uint8_t>(material);
            model_->table_row_i = uint32_t{request.mirrors[material] != 0} << 24 | uint32_t{colour[0]} << 16 |
                                  uint32_t{colour[1]} << 8 | colour[2];
            clock();
        }
        model_->table_write_i = 0;
        const uint32_t position_mask = limits_.position_bits < 32 ? (1u << limits_.position_bits) - 1 : ~0u;
        for (int axis = 0; axis < 3; ++axis) {
            model_->position_i[axis] = static_cast<uint32_t>(request.position[axis]) & position_mask;
            model_->look_i[axis] = static_cast<uint16_t>(request.look[axis]);
            model_->right_i[axis] = static_cast<uint16_t>(request.right[axis]);
            model_->up_i[axis] = static_cast<uint16_t>(request.up[axis]);
            model_->light_i[axis] =
                static_cast<uint32_t>(request.light_position[axis]) & ((1u << limits_.light_bits()) - 1);
        }
        // voxrt_pkg::shading_t.
        model_->shading_i =
            static_cast<uint16_t>(request.flat << 13 | request.light << 12 | request.ambient << 4 | request.bounces);
        model_->root_i = request.root;
        model_->width_i = static_cast<uint16_t>(request.width);
        model_->height_i = static_cast<uint16_t>(request.height);
        model_->depth_i = static_cast<uint8_t>(request.depth);
    }

    // What voxrt_octree_memory keeps for a word of the report dialect.
    uint32_t memory_word(uint32_t word) const {
        const unsigned payload_bits = limits_.block_bits > 9 ? limits_.block_bits : 9;
        const uint32_t leaf = 1u << payload_bits;
        if (word >> 31)
            return leaf | (word & 0xFF);
        if ((word & 7) != 1 || word >> (limits_.block_bits + 3))
            return leaf | 0x100;
        return word >> 3;
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
    VerilatedContext context_;
    std::unique_ptr<Model> model_;
};

} // namespace voxrt::rtl
