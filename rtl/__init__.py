"""The SystemVerilog core: its sources, its register map and its named configurations."""
