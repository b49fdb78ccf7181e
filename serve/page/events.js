// Events that carry a value.

/** E: the values by the names of the events. @template {object} E */
export class Events extends EventTarget {
  /** @template {keyof E & string} T @param {T} type @param {(detail: E[T]) => void} handler */
  on(type, handler) {
    this.addEventListener(type, (event) => handler(/** @type {CustomEvent<E[T]>} */ (event).detail));
  }

  /** @template {keyof E & string} T @param {T} type @param {E[T]} detail */
  emit(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }
}
