// How the page's workers answer: hand.js has the other end.

export const count = (number) => number.toLocaleString("en");

// calls: functions by name. They take what was sent, and `say`, which reports a stage.
export function answerWith(calls) {
  onmessage = async ({ data: { id, call, ...given } }) => {
    try {
      const result = await calls[call](given, (stage) => postMessage({ id, stage }));
      const pixels = result?.pixels ?? result?.colour;
      postMessage({ id, result }, pixels ? [pixels.buffer] : []);
    } catch (error) {
      postMessage({ id, problem: String(error?.message ?? error).split("\n")[0] });
    }
  };
}
