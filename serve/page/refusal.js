// Why no connection was made. A browser tells a page nothing of a refused WebSocket, so the page asks over HTTP.

/** @typedef {"token" | "origin" | "version" | "full" | "gone" | "lost"} Reason */
/** @typedef {{ reason: Reason, text?: string }} Refusal */

/** @type {Record<number, Reason>} */ const REASONS = { 401: "token", 403: "origin", 404: "version", 503: "full" };

/** The reason is "gone" when no server answers, and "lost" where there is no other. @param {string} path @param
 * {Record<string, string>} query @returns {Promise<Refusal>} */
export async function askForReason(path, query) {
  const fields = new URLSearchParams(query);
  fields.set("origin", location.origin);
  try {
    const answer = await fetch(`${path}?${fields}`, { cache: "no-store", signal: AbortSignal.timeout(5000) });
    return { reason: REASONS[answer.status] ?? "lost", text: (await answer.text()).trim() };
  } catch {
    return { reason: "gone" };
  }
}
