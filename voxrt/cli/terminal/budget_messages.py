"""What commands say of fitting an asset to a budget of words."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import voxrt


def budget_loss(budget: voxrt.BudgetFit) -> str:
    """Say what a memory that does not fit gives up, and which depth does; nothing if it gives up little."""
    if budget.lossless is None:
        return ""
    depth, words = budget.lossless
    return (
        f"{budget.words:,} words give up {budget.fit.percent_changed:.0f} % of the surface; "
        f"--depth {depth} fits without loss, in {words:,} words"
    )


def budget_text(budget: voxrt.BudgetFit) -> str:
    """Say what fitting a budget took."""
    fit = budget.fit
    if not (fit.changed or fit.appeared or fit.recoloured):
        return f"{budget.words:,} words are enough, nothing is given up"
    return (
        f"{budget.words:,} of {fit.words_shared:,} words: {fit.percent_changed:.2f} % of the surface changed, "
        f"PSNR {budget.psnr:.1f} dB, SSIM {budget.ssim:.3f}"
    )
