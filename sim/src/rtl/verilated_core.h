// Drives a verilated voxrt_core by its pins.
#pragma once

#include "core.h"
#include "dram.h"
#include "stall_pattern.h"

#include <verilated.h>

#include <memory>
#include <stdexcept>
#include <string>

namespace voxrt::rtl {

template <class Model> class VerilatedCore final : public Core {
public:
    explicit VerilatedCore(const Limits& limits) : limits_(limits) {
        context_.threads(VOXRT_RTL_THREADS);
        enter();
        model_ = std::make_unique<Model>(&context_, "TOP");
        model_->rst_ni = 0;
        for (int i = 0; i < 16; ++i)
            clock();
        model_->rst_ni = 1;
        clock();
    }

    ~VerilatedCore() override {
        enter();
        model_.reset();
        Verilated::threadContextp(Verilated::defaultContextp());
    }

    const Limits& limits() const override { return limits_; }

    uint32_t read(uint32_t address) override {
        enter();
        model_->s_axil_araddr = static_cast<uint16_t>(address);
        model_->s_axil_arvalid = 1;
        clock_until([this] { return model_->s_axil_arready; }, address);
        model_->s_axil_arvalid = 0;
        model_->s_axil_rready = 1;
        uint32_t value = 0;
        unsigned response = 0;
        clock_until(
            [&] {
                value = model_->s_axil_rdata;
                response = model_->s_axil_rresp;
                return model_->s_axil_rvalid;
            },
            address);
        model_->s_axil_rready = 0;
        check(response, address);
        return value;
    }

    void write(uint32_t address, uint32_t value) override {
        enter();
        model_->s_axil_awaddr = static_cast<uint16_t>(address);
        model_->s_axil_wdata = value;
        model_->s_axil_wstrb = 0xF;
        model_->s_axil_awvalid = 1;
        model_->s_axil_wvalid = 1;
        // The two channels are taken in any order; each is offered until it is.
        bool address_taken = false, data_taken = false;
        clock_until(
            [&] {
                address_taken = model_->s_axil_awready;
                data_taken = model_->s_axil_wready;
                return address_taken || data_taken;
            },
            address);
        if (address_taken)
            model_->s_axil_awvalid = 0;
        if (data_taken)
            model_->s_axil_wvalid = 0;
        if (!address_taken)
            clock_until([this] { return model_->s_axil_awready; }, address);
        if (!data_taken)
            clock_until([this] { return model_->s_axil_wready; }, address);
        model_->s_axil_awvalid = 0;
        model_->s_axil_wvalid = 0;
        model_->s_axil_bready = 1;
        unsigned response = 0;
        clock_until(
            [&] {
                response = model_->s_axil_bresp;
                return model_->s_axil_bvalid;
            },
            address);
        model_->s_axil_bready = 0;
        check(response, address);
    }

    void map_external(uint32_t address, std::span<const uint32_t> words) override { dram_.map(words, address); }

    void read_memory(std::size_t address, std::span<uint32_t> words) override {
        enter();
        const std::size_t latency = limits_.form == MemoryForm::copies ? 3 : 6; // voxrt_pkg::access_clocks
        for (std::size_t i = 0; i < words.size() + latency; ++i) {
            model_->bram_en_i = i < words.size();
            model_->bram_addr_i = static_cast<uint32_t>(4 * (address + i));
            clock([&] {
                if (i >= latency)
                    words[i - latency] = model_->bram_rddata_o;
            });
        }
        model_->bram_en_i = 0;
    }

    void write_memory(std::size_t address, std::span<const uint32_t> words) override {
        enter();
        model_->bram_en_i = 1;
        model_->bram_we_i = 0xF;
        for (std::size_t i = 0; i < words.size(); ++i) {
            model_->bram_addr_i = static_cast<uint32_t>(4 * (address + i));
            model_->bram_wrdata_i = words[i];
            clock();
        }
        model_->bram_en_i = 0;
        model_->bram_we_i = 0;
    }

    void expect(unsigned width, unsigned height, uint32_t stall_seed) override {
        stalls_ = StallPattern(stall_seed);
        sink_.expect(width, height);
    }

    bool run(uint64_t clocks, const std::function<void()>& poll) override {
        enter();
        for (uint64_t i = 1; i <= clocks && sink_.open(); ++i) {
            clock();
            if (i % poll_interval == 0)
                poll();
        }
        return sink_.complete();
    }

    const FrameSink& sink() const override { return sink_; }

private:
    static constexpr uint64_t poll_interval = 1 << 16;
    static constexpr unsigned answer_clocks = 1000;

    // Verilator's run time works on the calling thread's context, in destructors too: never on one that is gone.
    void enter() { Verilated::threadContextp(&context_); }

    // What `sample` sees stood on the pins when the clock rose.
    template <class Sample> void clock(Sample sample) {
        model_->m_axis_tready = sink_.open() && !stalls_.next();
        const bool cached = limits_.form == MemoryForm::cached;
        if (cached)
            drive_bus();
        model_->clk_i = 0;
        model_->eval();
        sample();
        if (cached) {
            dram_.accept(0, model_->m_axi0_arvalid, model_->m_axi0_araddr, model_->m_axi0_rready);
            dram_.accept(1, model_->m_axi1_arvalid, model_->m_axi1_araddr, model_->m_axi1_rready);
            dram_.tick();
        }
        if (model_->m_axis_tvalid && model_->m_axis_tready)
            sink_.accept(model_->m_axis_tdata, model_->m_axis_tkeep, model_->m_axis_tuser, model_->m_axis_tlast);
        model_->clk_i = 1;
        model_->eval();
    }

    void clock() {
        clock([] {});
    }

    // Without rlast, which the core does not read.
    void drive_bus() {
        const Dram::Response& first = dram_.drive(0);
        model_->m_axi0_arready = first.arready;
        model_->m_axi0_rvalid = first.rvalid;
        model_->m_axi0_rdata = first.rdata;
        model_->m_axi0_rresp = static_cast<uint8_t>(first.rresp);
        const Dram::Response& second = dram_.drive(1);
        model_->m_axi1_arready = second.arready;
        model_->m_axi1_rvalid = second.rvalid;
        model_->m_axi1_rdata = second.rdata;
        model_->m_axi1_rresp = static_cast<uint8_t>(second.rresp);
    }

    template <class Condition> void clock_until(Condition condition, uint32_t address) {
        bool holds = false;
        for (unsigned i = 0; i < answer_clocks && !holds; ++i)
            clock([&] { holds = condition(); });
        if (!holds)
            throw std::runtime_error("no answer from the register at byte " + std::to_string(address));
    }

    static void check(unsigned response, uint32_t address) {
        if (response != 0)
            throw std::runtime_error("the register at byte " + std::to_string(address) + " refuses the access");
    }

    Limits limits_;
    VerilatedContext context_;
    std::unique_ptr<Model> model_;
    FrameSink sink_;
    StallPattern stalls_{0};
    Dram dram_;
};

} // namespace voxrt::rtl
